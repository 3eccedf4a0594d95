MODULE TriggGlue
    PERS tooldata tNozzle:=[TRUE,[[0,0,160],[1,0,0,0]],[1.5,[0,0,70],[1,0,0,0],0,0,0]];
    PERS wobjdata wPart:=[FALSE,TRUE,"",[[400,-100,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    VAR triggdata tgOn;
    VAR triggdata tgOff{2};
    VAR triggdata tgFlow;
    VAR triggdata tgInt;
    VAR triggdata tgRamp;
    VAR triggios gunOn{1};
    VAR triggiosdnum gunLen{1};
    VAR triggstrgo tsg{1};
    VAR intnum intCheck;
    VAR num nBeads:=0;
    VAR restartdata rd;
    CONST robtarget pS:=[[0,0,10],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pC:=[[110,50,10],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        ConfL\Off; ConfJ\Off; SingArea\Wrist;
        CirPathMode\ObjectFrame;
        initTriggs;
        MoveJ Offs(pS,0,0,100),v500,z10,tNozzle\WObj:=wPart;
        MoveL pS,v100,fine,tNozzle\WObj:=wPart;
        TriggL Offs(pS,100,0,0),v100,tgOn\T2:=tgFlow\T3:=tgInt,z1,tNozzle\WObj:=wPart;
        TriggC Offs(pC,15,0,0),Offs(pC,0,50,0),v80,tgFlow,z1,tNozzle\WObj:=wPart;
        TriggL Offs(pS,0,100,0),v100,tgOff{1}\T2:=tgOff{2},fine,tNozzle\WObj:=wPart;
        gunOn{1}.used:=TRUE;
        gunOn{1}.distance:=5;
        gunOn{1}.start:=TRUE;
        gunOn{1}.signalname:="doGun";
        gunOn{1}.equiplag:=0.05;
        gunOn{1}.setvalue:=1;
        TriggLIOs Offs(pS,0,0,0),v100\TriggData1:=gunOn,z5,tNozzle\WObj:=wPart;
        TriggJ Offs(pS,0,0,150),v500,tgRamp,fine,tNozzle\WObj:=wPart;
        MoveLDO Offs(pS,0,0,120),v500,z10,tNozzle\WObj:=wPart,doDone,1;
        MoveLSync Offs(pS,0,50,120),v500,z10,tNozzle\WObj:=wPart,"count";
        MoveJGO Offs(pS,0,100,150),v500,fine,tNozzle\WObj:=wPart,goStation\Value:=4;
        purge;
    ENDPROC
    PROC count()
        Incr nBeads;
    ENDPROC
    PROC initTriggs()
        TriggIO tgOn,0\Start\DOp:=doGun,1;
        TriggIO tgOff{1},20\DOp:=doGun,0;
        TriggIO tgOff{2},0.1\Time\GOp:=goFlow,0;
        TriggEquip tgFlow,10\Start,0.06\AOp:=aoFlow,5.5;
        CONNECT intCheck WITH trCheck;
        TriggInt tgInt,30\Start,intCheck;
        TriggRampAO tgRamp,10\Start,0.1,aoFlow,0,20;
        TriggStopProc rd\DO1:=doGun,doShadow;
    ENDPROC
    TRAP trCheck
        IF diFlowOk=0 THEN
            SetDO doAlarm,1;
        ENDIF
    ENDTRAP

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jpurge:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC purge()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tNozzle;
        MoveAbsJ jpurge\NoEOffs,v500,z20,tNozzle;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tNozzle\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tNozzle;
        MoveL pHere,v20,fine,tNozzle;
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