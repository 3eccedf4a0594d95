MODULE MainModule
  !----------------------------------------------------------
  ! Lathe loading, double gripper. A = raw part, B = finished part
  !----------------------------------------------------------
  VAR intnum irAlarm:=0;
  VAR num nPick:=0;
  VAR bool bStopCycle:=FALSE;
  VAR triggdata trigDoor;
  CONST num nRows:=2;
  CONST num nCols:=3;
  CONST num nPitchX:=85.5;
  CONST num nPitchY:=-70;

  PROC main()
    rInit;
    rHome;
    WHILE NOT bStopCycle DO
      TEST GInput(giOrder)
      CASE 1,2:
        rLoadCycle;
      CASE 9:
        rMaintenance;
      DEFAULT:
        rLoadCycle;
      ENDTEST
      nCycle:=nCycle+1;
      nPick:=nPick+1;
      IF nPick>=nRows*nCols bStopCycle:=TRUE;
    ENDWHILE
    rHome;
  ENDPROC

  PROC rInit()
    AccSet 100,60;
    VelSet 100,2500;
    ConfJ\On;
    ConfL\Off;
    MotionSup\Off;
    rGripper\A,GRIP_OPEN;
    rGripper\B,GRIP_OPEN;
    IDelete irAlarm;
    CONNECT irAlarm WITH trAlarm;
    ISignalDI diLatheAlarm,1,irAlarm;
    TriggEquip trigDoor,50,0.1\DOp:=doOpenDoor,1;
    IF bFirst THEN
      nPartNo:=0;
      bFirst:=FALSE;
    ENDIF
    nPick:=0;
    TPWrite "Part "+stPart+" no. "\Num:=nPartNo;
  ENDPROC

  PROC rLoadCycle()
    rPickRaw nPick DIV nCols,nPick MOD nCols;
    rExchange;
    rPlaceDone nPick DIV nCols,nPick MOD nCols;
  ENDPROC

  PROC rPickRaw(num nRow,num nCol)
    VAR robtarget pNow;
    pNow:=Offs(pTray,nCol*nPitchX,nRow*nPitchY,0);
    MoveJ pTrayApp,vFast,zLoose,tGripA\WObj:=wTray;
    MoveL Offs(pNow,0,0,80),vFast,z20,tGripA\WObj:=wTray;
    MoveL pNow,vSlow,fine,tGripA\WObj:=wTray;
    rGripper\A,GRIP_CLOSE;
    GripLoad loadRaw;
    MoveL RelTool(pNow,0,0,-110),vFast,zLoose,tGripA\WObj:=wTray;
    MoveL pTrayApp,vFast,zLoose,tGripA\WObj:=wTray;
  ENDPROC

  PROC rExchange()
    MoveJ pDoor,vFast,z50,tGripA\WObj:=wLathe;
    WaitUntil diDoorOpen=1 AND diSpindleStop=1;
    ! finished part out
    MoveJ Offs(pChuckB,0,150,140),vFast,z20,tGripB\WObj:=wLathe;
    MoveL Offs(pChuckB,0,0,60),vFast,z10,tGripB\WObj:=wLathe;
    MoveL pChuckB,vSlow,fine,tGripB\WObj:=wLathe;
    rGripper\B,GRIP_CLOSE;
    SetDO doChuckOpen,1;
    WaitDI diChuckOpen,1;
    WaitTime 0.2;
    MoveL RelTool(pChuckB,0,0,-75),vSlow,z5,tGripB\WObj:=wLathe;
    MoveL Offs(pChuckB,0,150,140),v500,z20,tGripB\WObj:=wLathe;
    ! raw part in
    MoveJ pInside,vFast,z20,tGripA\WObj:=wLathe;
    MoveL Offs(pChuck,0,0,60),v200,z5,tGripA\WObj:=wLathe;
    MoveL pChuck,vSlow\V:=60,fine,tGripA\WObj:=wLathe;
    SetDO doChuckOpen,0;
    WaitDI diChuckOpen,0;
    rGripper\A,GRIP_OPEN;
    GripLoad loadDone;
    MoveL RelTool(pChuck,0,0,-80),v300,z10,tGripA\WObj:=wLathe;
    MoveL pInside,vFast,zLoose,tGripA\WObj:=wLathe;
    MoveL pDoor,vFast,z50,tGripA\WObj:=wLathe;
    PulseDO\PLength:=1,doStartLathe;
  ENDPROC

  PROC rPlaceDone(num nRow,num nCol)
    VAR robtarget pNow;
    pNow:=pTrayOut;
    pNow.trans.x:=pNow.trans.x+nCol*nPitchX;
    pNow.trans.y:=pTrayOut.trans.y+nRow*nPitchY;
    MoveJ Offs(pNow,0,0,200),vFast,zLoose,tGripB\WObj:=wTray;
    MoveL Offs(pNow,0,0,30),vFast,z5,tGripB\WObj:=wTray;
    MoveL pNow,vSlow,fine,tGripB\WObj:=wTray;
    rGripper\B,GRIP_OPEN;
    GripLoad load0;
    MoveL Offs(pNow,0,0,200),vFast,zLoose,tGripB\WObj:=wTray;
    Incr nPartNo;
  ENDPROC

  PROC rHome()
    MoveAbsJ jHome,v500,fine,tool0;
    SetDO doHomePos,1;
  ENDPROC

  PROC rMaintenance()
    TPWrite "Maintenance position";
    MoveJ pHome,v500,fine,tool0;
    Stop;
  ENDPROC

  TRAP trAlarm
    TPWrite "Lathe alarm";
    SetDO doStartLathe,0;
    ExitCycle;
  ENDTRAP
ENDMODULE
