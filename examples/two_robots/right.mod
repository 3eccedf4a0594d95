MODULE right
  PERS tooldata rod := [TRUE,[[0,0,300],[1,0,0,0]],[20,[0,0,150],[1,0,0,0],0,0,0]];
  CONST robtarget home := [[2100,600,1300],[0,-0.866,0,0.5],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget mid := [[1650,0,1000],[0,-0.866,0,0.5],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget side := [[2000,-700,1000],[0,-0.866,0,0.5],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfJ \Off; ConfL \Off;
    MoveJ home, v1000, fine, rod;
    WaitDI diFree, 1;
    MoveJ mid, v1000, z50, rod;
    MoveL side, v500, fine, rod;
    SetDO doOut, 1;
    MoveL [[2050,-300,1300],[0,-0.866,0,0.5],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, z50, rod;
    MoveJ home, v1000, fine, rod;
  ENDPROC
ENDMODULE
