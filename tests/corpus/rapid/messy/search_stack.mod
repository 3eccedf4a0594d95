MODULE SearchStack
    ! Suche auf dem Stapel: höchstens 270 mm
    PERS tooldata tSuck:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    VAR robtarget pFound;
    VAR robtarget pLast;
    VAR bool bFirst:=TRUE;
    VAR num nMissed:=0;
    PERS num nHeight:=0;
    CONST robtarget pTop:=[[450,-150,420],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pBottom:=[[450,-150,150],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pDrop:=[[400,200,250],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        ConfJ\Off; ConfL\Off;
        MoveJ pTop,v500,fine,tSuck;
        FOR n FROM 1 TO 3 DO
            fromStack;
            drop;
        ENDFOR
        MoveJ pTop,v500,fine,tSuck;
        parkStack;
    ENDPROC
    PROC fromStack()
        VAR num nDist;
        IF bFirst THEN
            MoveJ pTop,v800,fine,tSuck;
        ELSE
            MoveJ Offs(pLast,0,0,60),v800,fine,tSuck;
        ENDIF
        SearchL\PStop,diTouch\Flanks,pFound,pBottom,v50,tSuck;
        pLast:=pFound;
        bFirst:=FALSE;
        nDist:=Distance(pTop.trans,pFound.trans);
        nHeight:=pFound.trans.z-pBottom.trans.z;
        IF nHeight<2 THEN
            TPWrite "stack empty";
        ENDIF
        MoveL RelTool(pFound,0,0,2),v20,fine,tSuck;
        SetDO doSuck,1;
        WaitDI diVac,1\MaxTime:=2;
        MoveL Offs(pFound,0,0,100),v200,z10,tSuck;
        MoveL pTop,v800,z50,tSuck;
    ERROR
        IF ERRNO=ERR_WHLSEARCH THEN
            StorePath;
            MoveL pTop,v200,fine,tSuck;
            RestoPath;
            ErrWrite\I,"Stack empty","Fill the stack";
            Incr nMissed;
            Stop;
            RETRY;
        ELSEIF ERRNO=ERR_SIGSUPSEARCH OR ERRNO=ERR_WAIT_MAXTIME THEN
            TRYNEXT;
        ENDIF
    ENDPROC
    PROC drop()
        MoveJ Offs(pDrop,0,0,150),v800,z50,tSuck;
        MoveL pDrop,v100,fine,tSuck;
        Reset doSuck;
        PulseDO\PLength:=0.2,doBlow;
        WaitTime 0.2;
        MoveL Offs(pDrop,0,0,150),v500,z20,tSuck;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkStack:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkStack()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tSuck;
        MoveAbsJ jparkStack\NoEOffs,v500,z20,tSuck;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tSuck\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tSuck;
        MoveL pHere,v20,fine,tSuck;
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
