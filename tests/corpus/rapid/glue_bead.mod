MODULE GlueBead
  !*******************************************************
  ! Cover plate M7: one bead, 2-component adhesive
  ! cycle time target 14.5 s (was 17)
  ! p10..p90 taught with the 0.6 mm gauge under the nozzle
  !*******************************************************
  PERS tooldata tNozzle := [TRUE,[[0,0,124.6],[1,0,0,0]],[0.9,[0,0,45],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wJig := [FALSE,TRUE,"",[[430,-120,180],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];

  CONST speeddata vBead := [90, 180, 5000, 1000];
  CONST speeddata vCorner := [45, 180, 5000, 1000];
  CONST zonedata zBead := [FALSE, 3, 4.5, 4.5, 0.45, 4.5, 0.45];
  CONST zonedata zCorner := [FALSE, 0.8, 1.2, 1.2, 0.12, 1.2, 0.12];
  VAR stoppointdata spBead := [inpos, TRUE, [50, 50, 0.1, 0.5], 0, 0, "", 0, 0];

  LOCAL CONST jointtarget jSafe := [[20,-10,25,0,75,-20],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget pIn    := [[20,20,80],[0,-0.300706,0.953717,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget pStart := [[15.25,12.5,1.2],[0,-0.300706,0.953717,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p10 := [[60.125,12.5,1.2],[0,-0.300706,0.953717,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p20 := [[131.4,12.5,1.2],[0,-0.300706,0.953717,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p25 := [[143.128,17.357,1.2],[0,-0.325568,0.945519,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p30 := [[148,29.125,1.2],[0,-0.358368,0.93358,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p40 := [[148,90.6,1.2],[0,-0.358368,0.93358,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p45 := [[143.1,102.38,1.2],[0,-0.382683,0.92388,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p50 := [[131.35,107.25,1.2],[0,-0.406737,0.913545,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p60 := [[75,107.25,1.2],[0,-0.406737,0.913545,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p70 := [[28.8,107.25,1.2],[0,-0.406737,0.913545,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p75 := [[17.1,102.4,1.2],[0,-0.406737,0.913545,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p80 := [[12.3,90.7,1.2],[0,-0.382683,0.92388,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget p90 := [[12.3,40.2,1.2],[0,-0.34202,0.939693,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget pEnd := [[13.9,16,1.2],[0,-0.309017,0.951057,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget pPurge := [[310.5,260.25,310],[0,-0.300706,0.953717,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

  PERS num nParts := 0;
  PERS num nSincePurge := 38;
  CONST num nPurgeAfter := 40;
  VAR bool bPurge := FALSE;
  VAR num nWait;

  PROC main()
    ConfJ \On;
    ConfL \Off;
    SingArea \Off;
    AccSet 100, 100;
    SetDO doGlue, 0;
    MoveAbsJ jSafe, v1000, fine, tNozzle;
    FOR i FROM 1 TO 2 DO
      WaitDI diJigClamped, high;
      bead;
      Incr nParts;
      Incr nSincePurge;
      bPurge := nSincePurge >= nPurgeAfter;
      IF bPurge THEN
        purge 2.5;
        nSincePurge := 0;
      ENDIF
    ENDFOR
    MoveAbsJ jSafe, v1000, fine, tNozzle;
    TPWrite "parts: " \Num:=nParts;
  ENDPROC

  PROC bead()
    MoveJ pIn, v800, z20, tNozzle \WObj:=wJig;
    ! direction: clockwise seen from above,
    ! corners slower or the bead gets fat there

    ! open the valve a little before the start: hose delay 60 ms
    MoveLDO pStart, v200, z0, tNozzle \WObj:=wJig, doGlue, 1;
    MoveL p10, vBead, zBead, tNozzle \WObj:=wJig;
    MoveL p20, vBead \V:=110, zBead, tNozzle \WObj:=wJig;
    MoveC p25, p30, vCorner, zCorner, tNozzle \WObj:=wJig;
    MoveL p40, vBead, zBead \Z:=5, tNozzle \WObj:=wJig;
    MoveC p45, p50, vCorner, zCorner, tNozzle \WObj:=wJig;
    MoveL p60, vBead, z1, tNozzle \WObj:=wJig;
    MoveL p70, vBead, zBead, tNozzle \WObj:=wJig;
    MoveC p75, p80, vCorner, zCorner, tNozzle \WObj:=wJig;
    MoveL p90, vBead, zBead, tNozzle \WObj:=wJig;
    MoveLDO pEnd, vBead, z0, tNozzle \WObj:=wJig, doGlue, 0;
    MoveL Offs(pEnd, 0, 0, 3), v20, z0, tNozzle \WObj:=wJig;
    MoveL RelTool(pEnd, 0, 0, -70), v500, z10 \Inpos:=inpos50, tNozzle \WObj:=wJig;
  UNDO
    SetDO doGlue, 0;
  ENDPROC

  ! let the mixed glue out before it sets in the nozzle
  PROC purge(num seconds)
    VAR num n := 0;
    MoveJ Offs(pPurge, 0, 0, 60), v1000, z50, tNozzle;
    MoveL pPurge, v100 \T:=1.2, fine, tNozzle;
    WHILE n < 2 DO
      SetDO doGlue, 1;
      WaitTime seconds / 2;
      SetDO doGlue, 0;
      WaitTime \InPos, 0.3;
      n := n + 1;
    ENDWHILE
    MoveL Offs(pPurge, 0, 0, 60), v200, z10, tNozzle;
  ENDPROC
ENDMODULE
