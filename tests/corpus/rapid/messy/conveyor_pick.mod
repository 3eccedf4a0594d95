MODULE CnvPick
    PERS tooldata tVac:=[TRUE,[[0,0,110],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
    PERS wobjdata wobjcnv1:=[FALSE,FALSE,"CNV1",[[400,-150,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    PERS wobjdata wTray:=[FALSE,TRUE,"",[[300,250,80],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    CONST robtarget pPick:=[[0,0,25],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,0]];
    CONST robtarget pPlace:=[[0,0,30],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,0]];
    CONST jointtarget Home:=[[0,-20,30,0,75,0],[9E+09,9E+09,9E+09,9E+09,9E+09,0]];
    VAR num nRow:=0;
    VAR num nCol:=0;
    VAR num nDone:=0;
    VAR intnum iLost;
    VAR triggdata tgVacOn;
    PROC main()
        Init;
        parkCnv;
        WHILE TRUE DO
            PickOne;
            PlaceOne;
            IF nDone>=6 THEN
                PulseDO\PLength:=0.2,doTrayFull;
                WaitUntil diTrayNew=1\MaxTime:=120\TimeFlag:=bTimeOut;
                nDone:=0;
            ENDIF
        ENDWHILE
    ERROR
        IF ERRNO=ERR_CNV_NOT_ACT THEN
            ActUnit CNV1;
            RETRY;
        ELSEIF ERRNO=ERR_CNV_DROPPED THEN
            TRYNEXT;
        ENDIF
    ENDPROC
    PROC Init()
        IDelete iLost;
        CONNECT iLost WITH tLost;
        ISignalDI diLost,1,iLost;
        TriggEquip tgVacOn,20,0.05\DOp:=doVac,1;
        PulseDO c1RemAllPObj;
        ConfL\Off; ConfJ\Off;
        MoveAbsJ Home,v500,z100,tVac;
        ActUnit CNV1;
        DropWObj wobjcnv1;
    ENDPROC
    PROC PickOne()
        IF c1ObjectsInQ<1 THEN
            MoveAbsJ Home,v500,z100,tVac;
        ENDIF
        WaitWObj wobjcnv1\RelDist:=50;
        MoveL Offs(pPick,0,0,80),v1000,z20,tVac\WObj:=wobjcnv1;
        TriggL pPick,v500,tgVacOn,z1,tVac\WObj:=wobjcnv1;
        WaitTime\InPos,0.05;
        MoveL Offs(pPick,0,0,80),v1000,z20,tVac\WObj:=wobjcnv1;
        DropWObj wobjcnv1;
    ENDPROC
    PROC PlaceOne()
        VAR robtarget p;
        nRow:=nDone DIV 3;
        nCol:=nDone MOD 3;
        p:=Offs(pPlace,nRow*40,nCol*40,0);
        MoveJ Offs(p,0,0,90),v1000,z20,tVac\WObj:=wTray;
        MoveL p,v300,fine,tVac\WObj:=wTray;
        Reset doVac;
        WaitTime 0.1;
        MoveL Offs(p,0,0,90),v1000,z20,tVac\WObj:=wTray;
        nDone:=nDone+1;
    ENDPROC
    TRAP tLost
        TPWrite "object lost";
        StopMove;
        ClearPath;
        StartMove;
    ENDTRAP
    VAR bool bTimeOut;

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkCnv:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkCnv()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tVac;
        MoveAbsJ jparkCnv\NoEOffs,v500,z20,tVac;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tVac\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tVac;
        MoveL pHere,v20,fine,tVac;
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
ENDMODULE