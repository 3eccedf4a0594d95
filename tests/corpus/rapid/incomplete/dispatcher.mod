MODULE Dispatcher
  ! jobs come from the cell computer, through the web interface
  PERS num nOrder:=0;
  PERS bool bPark:=FALSE;
  PERS string stAnswer:="";
  PERS robtarget pRack:=[[560,180,420],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  TASK PERS tooldata tSauger:=[TRUE,[[0,0,110],[1,0,0,0]],[0.9,[0,0,50],[1,0,0,0],0,0,0]];
  VAR num nShelf:=1;

  PROC main()
    nOrder:=0;
    bPark:=FALSE;
    WHILE TRUE DO
      IF nOrder<>0 THEN
        TEST nOrder
        CASE 1,2:
          FetchFrom nShelf;
        CASE 9:
          Park;
        DEFAULT:
          stAnswer:="unknown order "+ValToStr(nOrder);
        ENDTEST
        nOrder:=0;
      ENDIF
      WaitTime 0.05;
    ENDWHILE
  ENDPROC

  PROC FetchFrom(num shelf)
    MoveJ Offs(pRack,0,-(shelf-1)*360,120),v800,z20,tSauger;
    MoveL Offs(pRack,0,-(shelf-1)*360,0),v100,fine,tSauger;
    SetDO doVacuum,1;
    MoveL Offs(pRack,0,-(shelf-1)*360,120),v400,z20,tSauger;
    MoveJ Offs(pRack,0,-500,120),v800,fine,tSauger; ! across axis 1's zero
  ENDPROC

  PROC Park()
    MoveAbsJ [[0,-10,20,0,50,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v500,fine,tSauger;
  ENDPROC
ENDMODULE
