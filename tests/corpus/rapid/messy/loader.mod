MODULE Loader
    VAR string stFile:="HOME:/parts/";
    VAR loadsession ls;
    VAR num nPart:=2;
    VAR errnum e;
    PERS tooldata tG:=[TRUE,[[0,0,140],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    PROC main()
        ConfJ\Off; ConfL\Off;
        MoveAbsJ [[0,-20,30,0,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tG;
        Load\Dynamic,stFile+"loader_part.mod";
        %"LoaderPart:weldPart"%;
        UnLoad stFile+"loader_part.mod";
        StartLoad\Dynamic,stFile\File:="other.mod",ls;
        WaitLoad ls;
        %"other:doIt"% nPart,\Fast;
        CallByVar "step_",nPart;
        UnLoad\ErrIfChanged,stFile\File:="other.mod";
        EraseModule "other";
        parkLd;
    ERROR
        IF ERRNO=ERR_REFUNKPRC TRYNEXT;
        IF ERRNO=ERR_FILNOTFND THEN
            TPWrite "no such module";
            TRYNEXT;
        ENDIF
    ENDPROC
    PROC step_1()
        MoveAbsJ [[10,-20,30,0,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tG;
    ENDPROC
    PROC step_2()
        MoveAbsJ [[20,-20,30,0,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tG;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkLd:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkLd()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG;
        MoveAbsJ jparkLd\NoEOffs,v500,z20,tG;
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
ENDMODULE