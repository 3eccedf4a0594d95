MODULE Calib
    CONST jointtarget j1:=[[0,-20,30,0,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget j2:=[[5,-20,30,10,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget j3:=[[-5,-20,30,-10,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget j4:=[[0,-15,25,0,65,20],[9E9,9E9,9E9,9E9,9E9,9E9]];
    PERS tooldata tool1:=[TRUE,[[0,0,110.7],[1,0,0,0]],[0.7,[0,0,70],[1,0,0,0],0,0,0]];
    VAR num max_err;
    VAR num mean_err;
    VAR pos pts{4}:=[[1,0,0],[0,1,0],[-1,0,0],[0,-1,0]];
    VAR pos c;
    VAR num r;
    VAR pos nrm;
    VAR num A1{2,2}:=[[2,1],[1,3]];
    VAR num b{2}:=[3,5];
    VAR num xx{2};
    VAR loadidnum lid;
    PROC main()
        MoveAbsJ j1,v50,fine,tool0;
        MoveAbsJ j2,v50,fine,tool0;
        MoveAbsJ j3,v50,fine,tool0;
        MoveAbsJ j4,v50,fine,tool0;
        MToolTCPCalib j1,j2,j3,j4,tool1,max_err,mean_err;
        IF max_err>2 THEN
            TPWrite "too bad "\Num:=max_err;
        ENDIF
        FitCircle pts,c,r,nrm;
        MatrixSolve A1,b,xx;
        TuneServo ROB_1,1,110;
        TuneReset;
        IF ParIdRobValid(TOOL_LOAD_ID)=ROB_LOAD_VAL THEN
            LoadId TOOL_LOAD_ID,MASS_WITH_AX3,tool1\Accuracy:=r;
        ENDIF
        CornerPathWarning FALSE;
        SetSysData tool1;
        GetSysData tool1;
        TestSignDefine 1,resolver_angle,ROB_1,1,0;
        MoveAbsJ j1,v50,fine,tool1;
        parkCal;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkCal:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkCal()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveAbsJ jparkCal\NoEOffs,v500,z20,tool1;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tool1\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tool1;
        MoveL pHere,v20,fine,tool1;
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