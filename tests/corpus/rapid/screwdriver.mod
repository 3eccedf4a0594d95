%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE Screwdriver
    ! M4 x 12, 8 screws, torque controller CVI3 on PROFINET
    PERS tooldata tDriver:=[TRUE,[[0,0,238.4],[1,0,0,0]],[1.9,[0,0,110],[1,0,0,0],0,0,0]];
    TASK PERS wobjdata wPlate:=[FALSE,TRUE,"",[[410,-140,90],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];

    CONST robtarget pScrew{8}:=[
                                   [[20,15,12],[0,-0.300706,0.953717,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[80,15,12],[0,-0.317305,0.948324,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[140,15,12],[0,-0.333807,0.942641,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[200,15,12],[0,-0.350207,0.936672,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[20,85,18.5],[0,-0.366501,0.930418,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[80,85,18.5],[0,-0.382683,0.92388,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[140,85,18.5],[0,-0.398749,0.91706,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
                                   [[200,85,18.5],[0,-0.414693,0.909961,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]];
    CONST robtarget pFeeder:=[[380.25,280.5,160],[0,-0.34202,0.939693,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pReject:=[[250,350,240],[0,-0.382683,0.92388,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST jointtarget jHome:=[[0,-15,20,0,85,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

    RECORD result
        num torque;
        num angle;
        bool ok;
    ENDRECORD
    VAR result resScrew{8};
    PERS num nTry{8}:=[0,0,0,0,0,0,0,0];
    VAR num nBad;
    VAR bool bAbort:=FALSE;
    CONST num nTorqueMin:=1.9;
    CONST num nTorqueMax:=2.6;
    VAR intnum iTorque;
    VAR clock ck;
    LOCAL VAR speeddata vScrew:=[14,50,5000,1000];
    LOCAL CONST zonedata zFly:=[FALSE,25,40,40,4,40,4];

    PROC main()
        Start;
        FOR k FROM 1 TO 8 DO
            FetchScrew;
            DriveScrew k\fast;
            IF NOT resScrew{k}.ok THEN
                nTry{k}:=nTry{k}+1;
                Incr nBad;
            ENDIF
            IF bAbort GOTO finish;
        ENDFOR
    finish:
        IF nBad>2 THEN
            ThrowAway\slow;
        ELSE
            ThrowAway;
        ENDIF
        MoveAbsJ jHome,v800,fine,tDriver;
        Report;
    ENDPROC

    LOCAL PROC Start()
        ConfL\Off;
        ConfJ\Off;
        VelSet 100,3000;
        nBad:=0;
        FOR i FROM 1 TO 8 DO
            nTry{i}:=0;
            resScrew{i}.ok:=TRUE;
        ENDFOR
        IDelete iTorque;
        CONNECT iTorque WITH trTorque;
        ISignalDI\Single,diTorqueReached,1,iTorque;
        ISleep iTorque;
        MoveAbsJ jHome,v800,z50,tDriver;
    ENDPROC

    PROC FetchScrew()
        MoveJ RelTool(pFeeder,0,0,-70),v2000,zFly,tDriver;
        WaitDI diScrewReady,1\MaxTime:=10;
        MoveL pFeeder,v150,fine,tDriver;
        SetDO doVacuum,1;
        WaitTime\InPos,0.15;
        MoveL RelTool(pFeeder,0,0,-70),v600,zFly,tDriver;
    ERROR(ERR_WAIT_MAXTIME)
        TPWrite "feeder empty?";
        WaitTime 1;
        RETRY;
    ENDPROC

    PROC DriveScrew(num k\switch fast)
        VAR robtarget pAt;
        pAt:=pScrew{k};
        ToScrew pAt\fast?fast;
        IWatch iTorque;
        SetDO doTurn,1;
        ClkReset ck;
        ClkStart ck;
        MoveL RelTool(pAt,0,0,6),vScrew,fine,tDriver\WObj:=wPlate;
        WaitUntil diTorqueReached=1\MaxTime:=3;
        ClkStop ck;
        SetDO doTurn,0;
        SetDO doVacuum,0;
        ISleep iTorque;
        resScrew{k}.torque:=2.2;
        resScrew{k}.angle:=0;
        resScrew{k}.ok:=TorqueOk(resScrew{k}.torque);
        MoveL RelTool(pAt,0,0,-45),v600,zFly,tDriver\WObj:=wPlate;
    ENDPROC

    PROC ToScrew(robtarget pAt\switch fast)
        IF Present(fast) THEN
            MoveJ RelTool(pAt,0,0,-45),v2500,zFly,tDriver\WObj:=wPlate;
        ELSE
            MoveJ RelTool(pAt,0,0,-45),v800,z10,tDriver\WObj:=wPlate;
        ENDIF
        MoveL pAt,v80,z0,tDriver\WObj:=wPlate;
    ENDPROC

    FUNC bool TorqueOk(num nTorque)
        RETURN nTorque>=nTorqueMin AND nTorque<=nTorqueMax;
    ENDFUNC

    PROC ThrowAway(\switch slow)
        IF Present(slow) THEN
            MoveJ pReject,v300,fine,tDriver;
        ELSE
            MoveJ pReject,v1500,z50,tDriver;
        ENDIF
        PulseDO\PLength:=0.2,doBlow;
    ENDPROC

    PROC Report()
        VAR string st:="";
        FOR i FROM 1 TO 8 DO
            st:=st+NumToStr(nTry{i},0)+" ";
        ENDFOR
        TPWrite "bad: "\Num:=nBad;
        TPWrite st;
    ENDPROC

    TRAP trTorque
        SetDO doTurn,0;
    ENDTRAP
ENDMODULE