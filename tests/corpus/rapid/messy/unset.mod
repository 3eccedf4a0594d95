MODULE Unset
    ! points are taught later
    PERS tooldata tG:=[TRUE,[[0,0,0],[1,0,0,0]],[-1,[0,0,0],[1,0,0,0],0,0,0]];
    VAR robtarget pTeach1;
    VAR robtarget pTeach2;
    PERS wobjdata wNew;
    VAR speeddata vOwn;
    VAR num params{10};
    VAR num nParams;
    VAR orient oDown;
    CONST robtarget pHome:=[[450,0,450],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        ConfJ\Off; ConfL\Off;
        MoveJ pHome,v500,fine,tG;
        MoveJ pTeach1,v500,z10,tG;
        MoveL pTeach2,vOwn,fine,tG\WObj:=wNew;
        MoveL [[400,0,400],oDown,[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tG;
        nParams:=nParams+11;
        TPWrite "x "\Num:=params{nParams};
        MoveJ pHome,v500,fine,tG;
        parkUn;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkUn:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkUn()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG;
        MoveAbsJ jparkUn\NoEOffs,v500,z20,tG;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tG\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tG;
        MoveL pHere,v20,fine,tG;
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

    ! --- old, do not delete (KS) ---
    !PROC oldPick()
    !    MoveJ pOld1,v800,z50,tOld;
    !    MoveL pOld2,v100,fine,tOld;
    !    IF diOld=1 THEN
    !        Set doOld;
    !    ENDIF
    !ENDPROC
ENDMODULE