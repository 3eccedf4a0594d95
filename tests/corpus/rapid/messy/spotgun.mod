MODULE SpotGun
    ! Schweißzange 1, Kappen prüfen
    PERS tooldata tGun1:=[TRUE,[[0,0,300],[1,0,0,0]],[20,[0,0,150],[1,0,0,0],0,0,0]];
    PERS gundata gun1:=["X-Gun",1,1,1,0,3000,10];
    PERS spotdata sp1:=[1,2200,2.4,0.5];
    PERS spotdata sp2:=[2,2500,3,0.5];
    PERS forcedata tip:=[1000,0.5,0,10];
    CONST robtarget p10:=[[1300,-200,1000],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[0,9E9,9E9,9E9,9E9,9E9]];
    PROC main()
        ConfL\Off; ConfJ\Off;
        MoveJ p10,v1000,fine,tGun1;
        SpotL Offs(p10,0,0,-100),v500,gun1,sp1\InPos,tGun1;
        SpotL Offs(p10,0,100,-100),v500,gun1,sp2\Conc,tGun1;
        SpotJ Offs(p10,0,200,-100),v500,gun1,sp1\OpenHLift,tGun1;
        SetForce gun1,tip;
        Calibrate gun1\TipChg;
        IndGunMove gun1,20;
        STClose gun1.name,1000,2;
        STOpen "X-Gun";
        OpenHighLift gun1;
        MoveL p10,v1000,fine,tGun1;
        tipCheck;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jtipCheck:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC tipCheck()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[1250,0,1000],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tGun1;
        MoveAbsJ jtipCheck\NoEOffs,v500,z20,tGun1;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tGun1\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tGun1;
        MoveL pHere,v20,fine,tGun1;
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