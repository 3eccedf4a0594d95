MODULE OwnErrors
    VAR errnum ERR_NO_PART:=-1;
    VAR errnum ERR_BAD_TYPE:=-1;
    VAR num nTries:=0;
    VAR num nFaults:=0;
    VAR num nResult;
    VAR string stErr{3};
    PERS tooldata tGrip:=[TRUE,[[0,0,130],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    CONST robtarget pA:=[[450,-150,300],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pB:=[[450,150,300],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pSafe:=[[400,0,450],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        BookErrNo ERR_NO_PART;
        BookErrNo ERR_BAD_TYPE;
        ConfL\Off; ConfJ\Off;
        MoveJ pSafe,v500,fine,tGrip;
        handle 1;
        handle 2;
        handle 7;
        nResult:=divide(10,0);
        TPWrite "result "\Num:=nResult;
        MoveJ pSafe,v500,fine,tGrip;
        parkTool;
    ERROR
        TEST ERRNO
        CASE ERR_BAD_TYPE:
            nFaults:=nFaults+1;
            ErrWrite \W,"bad type","the type is not known"\RL2:="main"\RL3:="go on";
            MoveJ pSafe,v200,fine,tGrip;
            TRYNEXT;
        CASE ERR_DIVZERO:
            nResult:=0;
            TRYNEXT;
        DEFAULT:
            Stop;
        ENDTEST
    ENDPROC
    PROC handle(num nType)
        checkType nType;
        checkPart nType;
        MoveL Offs(pA,0,0,nType*10),v300,z10,tGrip;
        MoveL pB,v300,fine,tGrip;
    ERROR
        IF ERRNO=ERR_NO_PART THEN
            MoveJ pSafe,v100,fine,tGrip;
            RETRY;
        ELSE
            RAISE;
        ENDIF
    ENDPROC
    PROC checkType(num nType)
        IF nType<1 OR nType>4 RAISE ERR_BAD_TYPE;
    ENDPROC
    PROC checkPart(num nType)
        IF nType<>2 OR nTries>=2 RETURN;
        nTries:=nTries+1;
        RAISE ERR_NO_PART;
    ENDPROC
    FUNC num divide(num a,num b)
        RETURN a/b;
    ERROR
        IF ERRNO=ERR_DIVZERO RETURN -1;
    ENDFUNC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkTool:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkTool()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tGrip;
        MoveAbsJ jparkTool\NoEOffs,v500,z20,tGrip;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tGrip\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tGrip;
        MoveL pHere,v20,fine,tGrip;
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
