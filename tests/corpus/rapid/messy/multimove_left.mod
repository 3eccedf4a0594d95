MODULE T_ROB1_Main
    ! Arm 1 of two, carries the plate; arm 2 glues
    TASK PERS tasks task_list{2} := [["T_ROB1"],["T_ROB2"]];
    VAR syncident sync1;
    VAR syncident sync2;
    VAR syncident sync3;
    PERS tooldata tPlate:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,60],[1,0,0,0],0,0,0]];
    PERS bool bGlueReady:=FALSE;
    PERS num nPartCount:=0;
    CONST jointtarget jHome:=[[0,-20,30,0,75,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pFetch:=[[450,-200,250],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pSync1:=[[480,100,350],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pSync2:=[[480,180,350],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

    PROC main()
        IF NOT IsSyncMoveOn() THEN
            TPWrite "task "+GetTaskName()+" ready";
        ENDIF
        IF RunMode()<>RUN_CONT_CYCLE THEN
            TPWrite "single cycle";
        ENDIF
        IF OpMode()=OP_AUTO VelSet 100,1500;
        ConfJ\Off;
        ConfL\Off;
        MoveAbsJ jHome\NoEOffs,v500,fine,tPlate;
        fetch;
        WaitSyncTask sync1,task_list\TimeOut:=60;
        SyncMoveOn sync2,task_list;
        MoveJ pSync1\ID:=10,v300,fine,tPlate;
        MoveL pSync2,\ID:=20,v100,z10,tPlate;
        MoveL Offs(pSync2,0,0,80)\ID:=30,v200,fine,tPlate\WObj:=wobj0;
        SyncMoveOff sync3;
        bGlueReady:=FALSE;
        WaitUntil bGlueReady\PollRate:=0.1;
        Incr nPartCount;
        MoveAbsJ jHome,v500,fine,tPlate;
        parkMm;
    UNDO
        SyncMoveUndo;
    ENDPROC

    PROC fetch()
        MoveJ Offs(pFetch,0,0,120),v800,z50,tPlate;
        MoveL pFetch,v100,fine,tPlate;
        SetDO \Sync, do1Vac,1;
        WaitDI di1Vac,1\MaxTime:=3;
        MoveL Offs(pFetch,0,0,120),v400,z20,tPlate;
    ERROR
        IF ERRNO=ERR_WAIT_MAXTIME THEN
            UIMsgBox \Header:="Vacuum", "No plate" \Buttons:=btnRetryCancel \Icon:=iconError \Result:=nAnswer;
            IF nAnswer=resRetry RETRY;
            RAISE;
        ENDIF
    ENDPROC
    VAR btnres nAnswer;

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkMm:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkMm()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tPlate;
        MoveAbsJ jparkMm\NoEOffs,v500,z20,tPlate;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tPlate\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tPlate;
        MoveL pHere,v20,fine,tPlate;
        WaitTime 1.5;
    ENDPROC

    ! counters, kept over restarts
    LOCAL PERS num nShift{3}:=[0,0,0];
    LOCAL PERS string stLast{5}:=["","","","",""];
    LOCAL VAR clock ckTotal;
    PROC logLine(string st\num value)
        FOR i FROM Dim(stLast,1) TO 2 STEP -1 DO
            stLast{i}:=stLast{i-1};
        ENDFOR
        stLast{1}:=st;
        IF Present(value) stLast{1}:=st+"="+NumToStr(value,0);
        TPWrite stLast{1};
    ENDPROC
    PROC shiftReport()
        FOR i FROM 1 TO 3 DO
            TPWrite "shift "+ValToStr(i)+": "\Num:=nShift{i};
        ENDFOR
        ClkReset ckTotal;
    ENDPROC

    PROC serviceMenu()
        VAR num nChoice;
        TPErase;
        TPReadFK nChoice,"Service","Oil","Belt","Zero",stEmpty,"Back";
        IF nChoice=5 RETURN;
        IF nChoice=3 THEN
            MoveAbsJ [[0,0,0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v100,fine,tool0;
            Stop;
        ELSE
            UIMsgBox "See the manual, chapter "+ValToStr(nChoice);
        ENDIF
    ENDPROC
ENDMODULE
