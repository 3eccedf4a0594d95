MODULE left
  PERS tooldata rod := [TRUE,[[0,0,300],[1,0,0,0]],[20,[0,0,150],[1,0,0,0],0,0,0]];
  CONST robtarget home := [[1200,-600,1300],[0.5,0,0.866,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget mid := [[1650,0,1000],[0.5,0,0.866,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget side := [[1300,700,1000],[0.5,0,0.866,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfJ \Off; ConfL \Off;
    MoveJ home, v1000, fine, rod;
    WaitDI diEnter, 1;
    MoveJ mid, v1000, z50, rod;
    MoveL side, v500, fine, rod;
    SetDO doLeft, 1;
    MoveL [[1250,300,1300],[0.5,0,0.866,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, z50, rod;
    MoveJ home, v1000, fine, rod;
  ENDPROC
ENDMODULE
