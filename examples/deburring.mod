%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE Deburring
  !***********************************************************
  !*  Deburring of pump housing 4711-B
  !*  Cell 12, IRB 6640-180/2.55, spindle and gripper on one hand
  !*
  !*  Größe der Fase: 0,5 mm x 45°      Werkzeug: Fräser Ø 6
  !*
  !*  2016-03-08  MK   first version
  !*  2018-11-21  JL   brush pass added (±0.2 mm), speeds raised
  !*  2021-06-02  MK   new fixture, wobjFix taught again
  !***********************************************************

  ! ---- hand -------------------------------------------------
  PERS tooldata tSpindle:=[TRUE,[[-64.4,2.1,378.15],[0.93358,0,-0.358368,0]],[21.6,[-18.2,0,142.5],[1,0,0,0],0.412,0.398,0.155]];
  PERS tooldata tGripper:=[TRUE,[[-118.5,3.2,271],[0.978148,0,-0.207912,0]],[21.6,[-18.2,0,142.5],[1,0,0,0],0.412,0.398,0.155]];
  PERS loaddata loHousing:=[8.4,[0,0,62],[1,0,0,0],0.061,0.105,0.142];

  ! ---- frames -----------------------------------------------
  TASK PERS wobjdata wobjFix:=[FALSE,TRUE,"",[[1180.25,-575.4,612.8],[0.999328,0,0,0.036644]],[[60,45,12.5],[1,0,0,0]]];
  TASK PERS wobjdata wobjConv:=[FALSE,TRUE,"",[[620,1010,455.3],[0.707107,0,0,0.707107]],[[0,0,0],[1,0,0,0]]];

  ! ---- speeds and zones -------------------------------------
  CONST speeddata vDeburr:=[85,120,5000,1000];
  CONST speeddata vBrush:=[160,200,5000,1000];
  CONST speeddata vCarry:=[1200,180,5000,1000];
  !CONST speeddata vDeburr:=[60,120,5000,1000];    ! before new spindle
  CONST zonedata zCorner:=[FALSE,3,4.5,4.5,0.5,4.5,0.5];
  CONST zonedata zAir:=[FALSE,18,28,28,2.8,28,2.8];

  ! ---- options ----------------------------------------------
  CONST bool bBrush:=TRUE;
  CONST bool bMeasure:=FALSE;
  CONST num nHoles:=4;
  CONST num hAir:=120;
  CONST num hPick:=190;
  VAR num nPass:=0;

  ! ---- stations ---------------------------------------------
  CONST jointtarget jHome:=[[0,-20,22,0,74,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST jointtarget jConv:=[[48.5,-8,31.25,0,66.75,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  CONST robtarget pPick:=[[310,95.5,42.3],[0,-0.325568,0.945519,0],[0,-1,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pPlace:=[[210,140,62.3],[0,0.358368,0.93358,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  ! taught 2018, old fixture
  !CONST robtarget pPlace:=[[1402.11,-226.4,655.02],[0.006131,0.104527,0.994447,0.009115],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

  ! ---- outer contour, counter-clockwise, tool leads by 8 deg --
  CONST robtarget pC10:=[[45,0,-0.5],[0.028373,0.405746,0.91132,-0.063726],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC20:=[[375,0,-0.5],[0.028373,0.405746,0.91132,-0.063726],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC25:=[[406.82,13.18,-0.5],[0.022118,0.422039,0.905066,-0.047432],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC30:=[[420,45,-0.5],[0.015299,0.438104,0.898247,-0.031367],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC40:=[[420,235,-0.5],[0.015299,0.438104,0.898247,-0.031367],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC45:=[[406.82,266.82,-0.5],[0.007376,0.422554,0.90617,-0.015817],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC50:=[[375,280,-0.5],[0.010647,-0.406597,-0.913232,-0.023914],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC60:=[[45,280,-0.5],[0.028373,-0.405746,-0.91132,-0.063726],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC65:=[[13.18,266.82,-0.5],[0.020869,-0.398203,-0.915803,-0.047995],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC70:=[[0,235,-0.5],[0.013636,-0.390493,-0.919944,-0.032125],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC80:=[[0,45,-0.5],[0.013636,0.390493,0.919944,-0.032125],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pC85:=[[13.18,13.18,-0.5],[0.020869,0.398203,0.915803,-0.047995],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

  ! ---- bolt holes -------------------------------------------
  CONST robtarget pHole{4}:=[
    [[70,70,-2],[0,0.446198,0.894934,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
    [[350,70,-2],[0,0.446198,0.894934,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
    [[350,210,-2],[0,0.446198,0.894934,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
    [[70,210,-2],[0,0.446198,0.894934,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]];

  !-----------------------------------------------------------
  PROC main()
    ConfJ\On;
    ConfL\On;
    SingArea \Off;
    AccSet 100,100;
    VelSet 100,5000;
    Reset doSpindle;
    Reset doAir;
    GripLoad load0;
    MoveAbsJ jHome,v1000,fine,tool0;
    TPWrite "Deburring of 4711-B";
    PickHousing;
    PlaceHousing;
    Set doSpindle;
    WaitTime 1.5;
    FOR i FROM 1 TO 2 DO
      nPass:=i;
      DeburrContour;
    ENDFOR
    DeburrHoles;
    DeburrSlot;
    IF bBrush THEN
      BrushFace;
    ENDIF
    IF bMeasure THEN
      ! probe is on cell 14 now
      MeasureFace;
    ELSE
      TPWrite "no measurement";
    ENDIF
    Reset doSpindle;
    FetchHousing;
    Park;
  ENDPROC

  !-----------------------------------------------------------
  ! Housing from the conveyor
  !-----------------------------------------------------------
  PROC PickHousing()
    Reset doGrip;
    MoveAbsJ jConv,vmax,z100,tGripper;
    MoveJ Offs(pPick,0,0,hPick),v1500,z40,tGripper\WObj:=wobjConv;
    MoveL Offs(pPick,0,0,60),v500,z15,tGripper\WObj:=wobjConv;
    MoveL pPick,v80,fine,tGripper\WObj:=wobjConv;
    Set doGrip;
    WaitTime 0.35;
    GripLoad loHousing;
    AccSet 60,100;
    MoveL Offs(pPick,0,0,60),v100,z15,tGripper\WObj:=wobjConv;
    MoveL Offs(pPick,0,0,hPick+40),vCarry,z50,tGripper\WObj:=wobjConv;
  ENDPROC

  PROC PlaceHousing()
    MoveJ Offs(pPlace,-60,40,260),vCarry,z50,tGripper\WObj:=wobjFix;
    MoveJ Offs(pPlace,0,0,hAir),vCarry,z20,tGripper\WObj:=wobjFix;
    MoveL Offs(pPlace,0,0,55),v300,z15,tGripper\WObj:=wobjFix;
    MoveL pPlace,v50,fine,tGripper\WObj:=wobjFix;
    Set doClamp;
    WaitTime 0.5;
    Reset doGrip;
    WaitTime 0.2;
    GripLoad load0;
    AccSet 100,100;
    MoveL Offs(pPlace,0,0,55),v200,z15,tGripper\WObj:=wobjFix;
    MoveL Offs(pPlace,0,0,240),v1000,z50,tGripper\WObj:=wobjFix;
  ENDPROC

  !-----------------------------------------------------------
  ! Outer edge: lines and four corners R45
  !-----------------------------------------------------------
  PROC DeburrContour()
    IF nPass=1 THEN
      TPWrite "contour, first pass";
      Movej RelTool(pC10,0,0,-hAir),v1500,zAir,tSpindle\wobj:=wobjFix;
    ELSE
      TPWrite "contour, second pass";
      movej offs(pC10,0,-75,95),v800,z15,tspindle\wobj:=wobjfix;
    ENDIF
    SetDO doAir,1;
    MoveL RelTool(pC10,0,0,-55),v500,z10,tSpindle\WObj:=wobjFix;
    MoveL pC10,v100,fine,tSpindle\WObj:=wobjFix;
    MoveL pC20,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveC pC25,pC30,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveL pC40,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveC pC45,pC50,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveL pC60,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveC pC65,pC70,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveL pC80,vDeburr,zCorner,tSpindle\WObj:=wobjFix;
    MoveC pC85,pC10,vDeburr,z1,tSpindle\WObj:=wobjFix;
    ! run over the start so that no burr stays
    MoveL Offs(pC10,60,0,0),vDeburr,z5,tSpindle\WObj:=wobjFix;
    MoveL Offs(pC10,90,-45,30),v200,z10,tSpindle\WObj:=wobjFix;
    MoveL RelTool(pC10,-60,0,-hAir),v800,z15,tSpindle\WObj:=wobjFix;
    SetDO doAir,0;
  ENDPROC

  !-----------------------------------------------------------
  ! Four bolt holes M10
  !-----------------------------------------------------------
  PROC DeburrHoles()
    FOR i FROM 1 TO nHoles DO
      MoveJ Offs(pHole{i},0,0,110),v1000,z15,tSpindle\WObj:=wobjFix;
      MoveL Offs(pHole{i},0,0,52),v400,z10,tSpindle\WObj:=wobjFix;
      Set doAir;
      MoveL pHole{i},v40,fine,tSpindle\WObj:=wobjFix;
      WaitTime 0.15;
      MoveL Offs(pHole{i},0,0,52),v150,z5,tSpindle\WObj:=wobjFix;
      Reset doAir;
      MoveL Offs(pHole{i},0,0,110),v500,z15,tSpindle\WObj:=wobjFix;
    ENDFOR
    !TPWrite "holes done";
  ENDPROC

  !-----------------------------------------------------------
  ! Slot for the O-ring, points set by hand
  !-----------------------------------------------------------
  PROC DeburrSlot()
    MoveJ [[140,105,118.5],[0.012289,0.469311,0.882645,-0.023113],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v1000,z20,tSpindle\WObj:=wobjFix;
      MoveL [[140,105,52.25],[0.012289,0.469311,0.882645,-0.023113],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v400,z15,tSpindle\WObj:=wobjFix;
      MoveL [[140,105,-1.2],[0.012289,0.469311,0.882645,-0.023113],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v60,fine,tSpindle\WObj:=wobjFix;
      MoveL [[280,105,-1.2],[0.012289,0.469311,0.882645,-0.023113],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vDeburr,z10,tSpindle\WObj:=wobjFix;
      MoveC [[304.75,115.25,-1.2],[0,0.45399,0.891007,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[315,140,-1.2],[0,0.45399,0.891007,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vDeburr,z10,tSpindle\WObj:=wobjFix;
      MoveC [[304.75,164.75,-1.2],[0,0.45399,0.891007,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[280,175,-1.2],[0.011475,-0.438221,-0.898486,-0.023528],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vDeburr,z10,tSpindle\WObj:=wobjFix;
      MoveL [[140,175,-1.2],[0.011475,-0.438221,-0.898486,-0.023528],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vDeburr,z10,tSpindle\WObj:=wobjFix;
      MoveC [[115.25,164.75,-1.2],[0,0.45399,0.891007,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[105,140,-1.2],[0,0.45399,0.891007,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vDeburr,z10,tSpindle\WObj:=wobjFix;
      MoveC [[115.25,115.25,-1.2],[0,0.45399,0.891007,0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],[[140,105,-1.2],[0.012289,0.469311,0.882645,-0.023113],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vDeburr,fine,tSpindle\WObj:=wobjFix;
      MoveL [[140,105,60],[0.012289,0.469311,0.882645,-0.023113],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z20,tSpindle\WObj:=wobjFix;
    MoveJ Offs(pC70,50,-60,140),v1000,z40,tSpindle\WObj:=wobjFix;
  ENDPROC

  !-----------------------------------------------------------
  ! Brush over the sealing face in lines of 300 mm
  !-----------------------------------------------------------
  PROC BrushFace()
    VAR robtarget pStart;
    VAR robtarget pEnd;
    VAR num y;

    AccSet 70,100;
    MoveJ Offs(pC80,60,15,90),v1000,z20,tSpindle\WObj:=wobjFix;
    FOR i FROM 0 TO 2 DO
      y:=15+i*70;
      pStart:=Offs(pC80,60,y,0.8);
      pEnd:=Offs(pStart,300,0,0);
      MoveL pStart,vBrush,z10,tSpindle\WObj:=wobjFix;
      MoveL pEnd,vBrush,z20,tSpindle\WObj:=wobjFix;
      MoveL Offs(pEnd,0,35,60),v600,z20,tSpindle\WObj:=wobjFix;
      MoveL Offs(pStart,0,70,60),v600,z15,tSpindle\WObj:=wobjFix;
    ENDFOR
    ! z200 is far too large here, the controller cuts it down
    MoveL Offs(pC80,60,225,210),v1000,z200,tSpindle\WObj:=wobjFix;
    MoveL Offs(pC80,180,225,330),v1000,z40,tSpindle\WObj:=wobjFix;
    AccSet 100,100;
  ENDPROC

  PROC MeasureFace()
    TPWrite "measuring";
    MoveL Offs(pC80,100,100,80),v500,fine,tSpindle\WObj:=wobjFix;
  ENDPROC

  !-----------------------------------------------------------
  ! Housing back to the conveyor
  !-----------------------------------------------------------
  PROC FetchHousing()
    MoveJ Offs(pPlace,0,0,240),v1500,z40,tGripper\WObj:=wobjFix;
    MoveL Offs(pPlace,0,0,60),v600,z15,tGripper\WObj:=wobjFix;
    MoveL pPlace,v80,fine,tGripper\WObj:=wobjFix;
    Set doGrip;
    WaitTime 0.35;
    Reset doClamp;
    WaitTime 0.5;
    GripLoad loHousing;
    AccSet 60,100;
    MoveL Offs(pPlace,0,0,60),v100,z15,tGripper\WObj:=wobjFix;
    MoveL Offs(pPlace,0,0,hAir+140),vCarry,z60,tGripper\WObj:=wobjFix;
    MoveJ Offs(pPick,0,250,hPick),vCarry,z30,tGripper\WObj:=wobjConv;
    MoveL Offs(pPick,0,250,60),v500,z15,tGripper\WObj:=wobjConv;
    MoveL Offs(pPick,0,250,0),v80,fine,tGripper\WObj:=wobjConv;
    Reset doGrip;
    WaitTime 0.35;
    GripLoad load0;
    AccSet 100,100;
    MoveL Offs(pPick,0,250,60),v200,z15,tGripper\WObj:=wobjConv;
    MoveL Offs(pPick,0,250,hPick),v1000,z30,tGripper\WObj:=wobjConv;
  ENDPROC

  PROC Park()
    ! MoveAbsJ jConv,v1000,z100,tGripper;
    MoveAbsJ jHome,v1500,fine,tool0;
    TPWrite "done";
  ENDPROC

ENDMODULE