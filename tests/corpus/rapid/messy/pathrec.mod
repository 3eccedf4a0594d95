MODULE PathRec
    VAR pathrecid safe_id;
    VAR pathrecid origin_id;
    VAR intnum intCrash;
    VAR robtarget pNow;
    VAR num nState:=0;
    PERS tooldata tG:=[TRUE,[[0,0,140],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    CONST robtarget p1:=[[400,-100,300],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget p2:=[[480,-100,300],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        ConfL\Off; ConfJ\Off;
        CONNECT intCrash WITH trCrash;
        ISignalDI diCrash,1,intCrash;
        MoveJ p1,v300,fine,tG;
        PathRecStart safe_id;
        MoveL p2,v300,z10,tG;
        MoveL Offs(p2,0,50,0),v300,z10,tG;
        MoveL Offs(p2,0,100,0),v300,fine,tG;
        StorePath;
        MoveL Offs(p2,0,100,60),v300,fine,tG;
        RestoPath;
        IF PathRecValidBwd(\ID:=safe_id) THEN
            PathRecMoveBwd\ID:=safe_id\ToolOffs:=[0,0,50]\Speed:=v200;
            PathRecMoveFwd;
        ENDIF
        PathRecStop\Clear;
        stepBack;
        SoftAct 3,40\Ramp:=110;
        SoftDeact\Ramp:=110;
        IDelete intCrash;
        MoveJ p1,v300,fine,tG;
        parkPr;
    ENDPROC
    PROC stepBack()
        pNow:=CRobT(\Tool:=tG);
        IF pNow.trans.z<350 MoveL Offs(pNow,0,0,350-pNow.trans.z),v100,fine,tG;
    ENDPROC
    TRAP trCrash
        StopMove;
        StorePath;
        PathRecMoveBwd;
        MoveL Offs(CRobT(\Tool:=tG),0,0,50),v50,fine,tG;
        PathRecMoveFwd;
        RestoPath;
        StartMove;
    ENDTRAP

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkPr:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkPr()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG;
        MoveAbsJ jparkPr\NoEOffs,v500,z20,tG;
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