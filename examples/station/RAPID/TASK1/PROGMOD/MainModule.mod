MODULE MainModule
  ! Greifer oben: Kühlung ein
  CONST robtarget pHome:=[[374,0,630],[0.707107,0,0.707107,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pA:=[[400,100,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pB:=[[400,-100,200],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ pHome,v1000,fine,tGrip;
    Pick;
    MoveJ pHome,v1000,fine,tGrip;
  ENDPROC
  PROC Pick()
    MoveJ pA,v1000,z10,tGrip\WObj:=wTable;
    MoveL Offs(pA,0,0,-50),v200,z5,tGrip\WObj:=wTable;
    WaitDI diPart,1;
    SetDO doGripper,1;
    MoveL Offs(pA,0,-50,-50),v200,z5,tGrip\WObj:=wTable;
    MoveL pB,v500,z5,tGrip\WObj:=wTable;
    MoveL Offs(pB,0,0,50),v500,fine,tGrip\WObj:=wTable;
  ENDPROC
ENDMODULE
