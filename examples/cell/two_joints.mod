MODULE two_joints
  ! Written by flyby.
  PERS tooldata rod := [TRUE,[[0,0,300],[1,0,0,0]],[20,[0,0,150],[1,0,0,0],0.1625,0.1625,0.025]];
  CONST speeddata v50000 := [50000,500,5000,1000];
  CONST jointtarget p0 := [[0,-4.1902504,69.06217,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST jointtarget p1 := [[0,-21.065327,62.33845,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST jointtarget p2 := [[0,-4.739422,42.6466,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST jointtarget p3 := [[0,22.295,18.62149,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST jointtarget p4 := [[0,38.266186,11.466975,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

  PROC main()
    MoveAbsJ p0,v50000,fine,rod;
    MoveAbsJ p1,v50000,z10,rod;
    MoveAbsJ p2,v50000,z10,rod;
    MoveAbsJ p3,v50000,z10,rod;
    MoveAbsJ p4,v50000,fine,rod;
  ENDPROC
ENDMODULE
