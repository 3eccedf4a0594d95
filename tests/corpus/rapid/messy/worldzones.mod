%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE WZones
  VAR wztemporary wzServ;
  PERS wztemporary wzWork := [0];
  VAR wzstationary wzHome := [0];
  PERS tooldata tG:=[TRUE,[[0,0,140],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
  CONST pos corner1:=[300,-300,0];
  CONST pos corner2:=[700,300,900];
  CONST jointtarget jpHome:=[[0,-20,30,0,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jpDelta:=[[2,2,2,2,2,2],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR clock ck;
  PROC power_on()
    VAR shapedata box;
    VAR shapedata joint_space;
    WZBoxDef\Inside,box,corner1,corner2;
    WZHomeJointDef\Inside,joint_space,jpHome,jpDelta;
    WZDOSet\Stat,wzHome\Inside,joint_space,doHome,1;
    WZLimSup\Temp,wzServ,box;
  ENDPROC
  PROC main()
    VAR shapedata volume;
    power_on;
    WZSphDef\Inside,volume,corner1,100;
    WZCylDef\Outside,volume,corner1,100,200;
    WZDisable wzServ;
    IF DOutput(doHome)=0 THEN
      MoveAbsJ jpHome,v100,fine,tG;
    ENDIF
    WHILE DOutput(doHome)<>1 DO
      WaitTime 0.1;
    ENDWHILE
    ConfL\Off; ConfJ \Off;
    PathAccLim TRUE\AccMax:=4,TRUE\DecelMax:=4;
    WorldAccLim\On:=3.5;
    MoveJ [[450,-100,300],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z20,tG;
    MoveL [[450,100,300],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[300,200,1000,1000],fine\Inpos:=inpos50,tG;
    WorldAccLim\Off;
    PathAccLim FALSE,FALSE;
    SpeedRefresh 70;
    MoveAbsJ jpHome\NoEOffs,v500,fine\Inpos:=[stoptime,TRUE,[0,0,0,0],0.5,0,"",0,0],tG;
    WZEnable wzServ;
    WZFree wzServ;
        parkZone;
  ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkZone:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkZone()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG;
        MoveAbsJ jparkZone\NoEOffs,v500,z20,tG;
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

    ! --- old, do not delete (KS) ---
    !PROC oldPick()
    !    MoveJ pOld1,v800,z50,tOld;
    !    MoveL pOld2,v100,fine,tOld;
    !    IF diOld=1 THEN
    !        Set doOld;
    !    ENDIF
    !ENDPROC
ENDMODULE