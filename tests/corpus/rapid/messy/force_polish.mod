MODULE Polish
    PERS tooldata tPol:=[TRUE,[[0,0,180],[1,0,0,0]],[2,[0,0,90],[1,0,0,0],0,0,0]];
    PERS wobjdata wPlate:=[FALSE,TRUE,"",[[450,-100,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    PERS loaddata TestLoad:=[0.001,[0,0,0.001],[1,0,0,0],0,0,0];
    CONST robtarget p10:=[[0,0,60],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    VAR fcforcevector fv;
    VAR bool bForce;
    VAR fcprocessdata pd;
    PROC main()
        ConfL\Off; ConfJ\Off;
        MoveJ p10,v200,fine,tPol\WObj:=wPlate;
        TestLoad:=FCLoadID();
        FCCalib TestLoad;
        fv:=FCGetForce(\Tool:=tPol);
        FCAct tPol\WObj:=wPlate;
        FCRefForce \Fz:=-20;
        FCCondForce\ZMin:=-25\ZMax:=-15,60;
        FCRefStart;
        FCCondWaitWhile;
        FCRefStop;
        FCDeact;
        FCPress1LStart Offs(p10,0,0,-40),v50,\Fz:=15,50,z5,tPol\WObj:=wPlate;
        FCPressL Offs(p10,0,100,-40),v50,15,z5,tPol\WObj:=wPlate;
        FCPressC Offs(p10,25,125,-40),Offs(p10,50,100,-40),v50,15,z5,tPol\WObj:=wPlate;
        FCPressEnd Offs(p10,50,100,20),v50,\DeactOnly,tPol\WObj:=wPlate;
        IF FCIsForceMode() TPWrite "still in force mode";
        MoveL p10,v200,fine,tPol\WObj:=wPlate;
        ContactL Offs(p10,0,0,-60),v20,tPol\WObj:=wPlate;
        CSSAct wPlate\Softness:=50;
        MoveL Offs(p10,0,0,-50),v100,fine,tPol\WObj:=wPlate;
        CSSDeactMoveL p10,v100,tPol\WObj:=wPlate;
        parkPol;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkPol:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkPol()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tPol;
        MoveAbsJ jparkPol\NoEOffs,v500,z20,tPol;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tPol\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tPol;
        MoveL pHere,v20,fine,tPol;
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