MODULE PmLayers
  VAR pm_wadescr waInFeeder;
  VAR bool MultiOperation:=FALSE;
  PERS num nLayer:=0;
  CONST num nRows:=3;
  CONST num nCols:=4;
  CONST num pitch{3}:=[120,90,45];
  CONST jointtarget jHome:=[[0,-20,20,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPal:=[[1000,200,550],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPick:=[[1100,-400,650],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR robtarget pNow;
    AccSet 80,60;
    VelSet 90,2500;
    MoveAbsJ jHome,v1000,fine,tool0;
    FOR layer FROM 0 TO 1 DO
      FOR r FROM 0 TO nRows-1 DO
        FOR c FROM nCols-1 TO 0 STEP -1 DO
          pNow:=pPal;
          pNow.trans:=pPal.trans+[r*pitch{1},c*pitch{2},layer*pitch{3}];
          IF layer MOD 2=1 pNow.rot:=pPal.rot*OrientZYX(90,0,0);
          PickOne pPick,100;
          PlaceOne pNow;
          Incr nLayer;
        ENDFOR
      ENDFOR
    ENDFOR
    TPReadFK reg1,"Weiter?","Ja","Nein",stEmpty,stEmpty,stEmpty;
    IF reg1=1 THEN
      MoveAbsJ jHome,v1000,fine,tool0;
    ENDIF
    UIMsgBox\Header:="A","fertig"\Buttons:=btnOK;
  ENDPROC
  PROC PickOne(robtarget p,num h)
    MoveJ Offs(p,0,0,h),vmax,z50,tool0;
    MoveL p,v300,fine,tool0;
    VakuumEin;
    MoveL Offs(p,0,0,h),v500,z50,tool0;
  ENDPROC
  PROC PlaceOne(robtarget p)
    MoveJ Offs(p,0,0,200),vmax,z50,tool0;
    MoveL p,v300,fine,tool0;
    VakuumAus;
    GripLoad load0;
    MoveL Offs(p,0,0,200),v500,z50,tool0;
  ENDPROC
ENDMODULE