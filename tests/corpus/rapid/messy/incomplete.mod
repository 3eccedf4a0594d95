MODULE MainModule
    ! from a backup; CalibData and User modules are missing
    VAR num nPallet:=1;
    VAR bool bLayerOk;
    PROC main()
        rInitialize;
        rNight;
        rCheckHomePos;
        WHILE TRUE DO
            IF diPartReady=1 THEN
                rPick;
                rPlace nPallet,bLayerOk;
                IF nPallet=1 THEN nPallet:=2; ELSE nPallet:=1; ENDIF
            ENDIF
            rCycleEnd;
            WaitTime 0.3;
        ENDWHILE
    ENDPROC
    PROC rPick()
        MoveJ Offs(pPickPos,0,0,200),vFast,z50,tGripper\WObj:=wobjConv;
        MoveL pPickPos,vSlow,fine,tGripper\WObj:=wobjConv;
        rGripClose;
        WaitTime 0.5;
        MoveL Offs(pPickPos,0,0,200),vFast,z50,tGripper\WObj:=wobjConv;
    ENDPROC
    PROC rPlace(num nSide,INOUT bool bOk)
        IF nSide=1 THEN
            MoveJ pPlaceL,vFast,z50,tGripper;
        ELSE
            MoveJ pPlaceR,vFast,z50,tGripper;
        ENDIF
        WaitTime 0.5;
        rGripOpen;
        bOk:=fCheckLayer(nSide);
    ENDPROC
    CONST robtarget pPickPos:=[[450,-100,200],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pPlaceL:=[[400,200,250],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pPlaceR:=[[400,-250,250],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jrNight:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC rNight()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveAbsJ jrNight\NoEOffs,v500,z20,tGripper;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tGripper\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tGripper;
        MoveL pHere,v20,fine,tGripper;
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

    ! --- old, do not delete (KS) ---
    !PROC oldPick()
    !    MoveJ pOld1,v800,z50,tOld;
    !    MoveL pOld2,v100,fine,tOld;
    !    IF diOld=1 THEN
    !        Set doOld;
    !    ENDIF
    !ENDPROC
ENDMODULE