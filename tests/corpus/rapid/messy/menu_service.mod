MODULE MenuService
    CONST listitem lstMain{4}:=[["","Pick"],["","Place"],["","Service"],["","Quit"]];
    VAR num nKey;
    VAR num nList;
    VAR num nCount;
    VAR btnres nBtn;
    VAR string stName;
    VAR bool bRun:=TRUE;
    PERS tooldata tGrip:=[TRUE,[[0,0,130],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    CONST robtarget pHome:=[[450,0,450],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pPick:=[[450,-200,250],[0,0,1,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        ConfJ\Off; ConfL\Off;
        TPErase;
        WHILE bRun DO
            TPReadFK nKey,"What now?","Pick",stEmpty,"Menu",stEmpty,"Quit"\MaxTime:=60\BreakFlag:=nErr;
            TEST nKey
            CASE 1:
                rPick;
            CASE 3:
                rMenu;
            CASE 5:
                bRun:=FALSE;
            DEFAULT:
                TPWrite "not used";
            ENDTEST
        ENDWHILE
        MoveJ pHome,v500,fine,tGrip;
        nightPos;
    ENDPROC
    VAR errnum nErr;
    PROC rPick()
        TPReadNum nCount,"How many? (1..9)";
        IF nCount<1 OR nCount>9 THEN
            TPWrite "wrong number";
            RETURN;
        ENDIF
        MoveJ pHome,v500,z50,tGrip;
        FOR i FROM 1 TO nCount DO
            MoveL Offs(pPick,(i-1)*20,0,100),v500,z20,tGrip;
            MoveL Offs(pPick,(i-1)*20,0,0),v100,fine,tGrip;
            SetDO doGrip,1;
            WaitTime 0.3;
            MoveL Offs(pPick,(i-1)*20,0,100),v500,z20,tGrip;
        ENDFOR
    ENDPROC
    PROC rMenu()
        nList:=UIListView(\Result:=nBtn\Header:="Service",lstMain\Buttons:=btnOKCancel\Icon:=iconInfo\DefaultIndex:=1);
        IF nBtn=resOK THEN
            TEST nList
            CASE 1,2:
                rPick;
            CASE 3:
                stName:=UIAlphaEntry(\Header:="Name"\Message:="Operator?"\Icon:=iconInfo\InitString:="nobody");
                nCount:=UINumEntry(\Header:="Count"\Message:="Parts"\InitValue:=5\MinValue:=1\MaxValue:=20\AsInteger);
            DEFAULT:
                bRun:=FALSE;
            ENDTEST
        ENDIF
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jnightPos:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC nightPos()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tGrip;
        MoveAbsJ jnightPos\NoEOffs,v500,z20,tGrip;
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

    ! --- old, do not delete (KS) ---
    !PROC oldPick()
    !    MoveJ pOld1,v800,z50,tOld;
    !    MoveL pOld2,v100,fine,tOld;
    !    IF diOld=1 THEN
    !        Set doOld;
    !    ENDIF
    !ENDPROC
ENDMODULE