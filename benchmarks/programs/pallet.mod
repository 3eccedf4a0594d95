MODULE Pallet
  ! Boxes from a belt over a wall on to a pallet, gripper held down.
  PERS tooldata tGrip:=[TRUE,[[0,0,220],[1,0,0,0]],[12,[0,0,90],[1,0,0,0],0,0,0]];
  CONST jointtarget jHome:=[[0,-20,20,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pBelt:=[[1350,-800,600],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pWall1:=[[1400,-350,1150],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pWall2:=[[1400,200,1150],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPal:=[[1300,750,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    MoveAbsJ jHome,v1500,fine,tGrip;
    MoveJ Offs(pBelt,0,0,400),v2000,z50,tGrip;
    MoveL Offs(pBelt,0,0,100),v1500,z20,tGrip;
    MoveL pBelt,v300,fine,tGrip;
    WaitTime 0.4;
    MoveL Offs(pBelt,0,0,150),v500,z20,tGrip;
    MoveL Offs(pBelt,0,0,500),v1500,z50,tGrip;
    MoveL pWall1,v2000,z50,tGrip;
    MoveL pWall2,v2000,z50,tGrip;
    MoveJ Offs(pPal,0,0,500),v2000,z50,tGrip;
    MoveL Offs(pPal,0,0,100),v1500,z10,tGrip;
    MoveL pPal,v200,fine,tGrip;
    WaitTime 0.4;
    MoveL Offs(pPal,0,0,150),v500,z20,tGrip;
    MoveL Offs(pPal,0,0,500),v1500,z50,tGrip;
    MoveJ pWall2,v2000,z50,tGrip;
    MoveJ pWall1,v2000,z50,tGrip;
    MoveJ Offs(pBelt,0,0,400),v2000,z50,tGrip;
    MoveAbsJ jHome,v1500,fine,tGrip;
  ENDPROC
ENDMODULE
