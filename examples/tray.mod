MODULE Tray
  ! Two parts from a tray, for any arm of 0.5 m and more: tool down, 0.3 to 0.35 m before the base.
  CONST robtarget above := [[300,0,360],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget tray := [[300,-80,290],[0,0,1,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget box := [[320,80,300],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

  PROC main()
    VAR num part := 0;
    MoveJ above,v200,fine,tool0;
    WHILE part < 2 DO
      MoveL Offs(tray,40*part,0,60),v200,z20,tool0;
      MoveL Offs(tray,40*part,0,0),v100,fine,tool0;
      Set do_gripper;
      WaitTime 0.3;
      MoveL Offs(tray,40*part,0,60),v200,z20,tool0;
      MoveL Offs(box,0,0,60),v200,z20,tool0;
      MoveL box,v100,fine,tool0;
      Reset do_gripper;
      WaitTime 0.2;
      MoveL Offs(box,0,0,60),v200,z20,tool0;
      part := part + 1;
    ENDWHILE
    MoveJ above,v200,fine,tool0;
  ENDPROC
ENDMODULE
