MODULE CsvPath
    VAR iodev f;
    VAR string line;
    VAR num x{200};
    VAR num y{200};
    VAR num n:=0;
    VAR bool ok;
    VAR num p1;
    VAR num p2;
    PERS tooldata tPen:=[TRUE,[[0,0,140],[1,0,0,0]],[0.3,[0,0,60],[1,0,0,0],0,0,0]];
    PERS wobjdata wPaper:=[FALSE,TRUE,"",[[400,-100,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    CONST robtarget pO:=[[0,0,0],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        ConfL\Off; ConfJ\Off;
        readFile "path.csv";
        MoveJ Offs(pO,0,0,100),v500,fine,tPen\WObj:=wPaper;
        FOR i FROM 1 TO n DO
            MoveL Offs(pO,x{i},y{i},0),v100,z1,tPen\WObj:=wPaper;
        ENDFOR
        MoveL Offs(pO,0,0,100),v500,fine,tPen\WObj:=wPaper;
        penUp;
    ENDPROC
    PROC readFile(string name)
        IF NOT IsFile("HOME:/"+name\RegFile) THEN
            TPWrite "no file";
            EXIT;
        ENDIF
        Open "HOME:/"+name,f\Read;
        line:=ReadStr(f\Delim:="\0A"\RemoveCR);
        WHILE line<>EOF AND n<200 DO
            p1:=StrFind(line,1,";");
            p2:=StrFind(line,p1+1,";");
            IF p1<=StrLen(line) THEN
                Incr n;
                ok:=StrToVal(StrPart(line,1,p1-1),x{n});
                ok:=StrToVal(StrPart(line,p1+1,p2-p1-1),y{n});
            ENDIF
            line:=ReadStr(f\Delim:="\0A");
        ENDWHILE
        Close f;
    ERROR
        IF ERRNO=ERR_FILEOPEN THEN
            TPWrite "cannot open";
            TRYNEXT;
        ENDIF
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jpenUp:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC penUp()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tPen;
        MoveAbsJ jpenUp\NoEOffs,v500,z20,tPen;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tPen\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tPen;
        MoveL pHere,v20,fine,tPen;
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
