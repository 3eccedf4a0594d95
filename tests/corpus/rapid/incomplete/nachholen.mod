%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE Nachholen
  LOCAL VAR num nX;
  VAR speeddata vMainFast:=[1200,500,5000,1000];
  PERS wobjdata wLoadin:=[FALSE,TRUE,"",[[600,-200,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  PERS tooldata tGrip:=[TRUE,[[0,0,180],[1,0,0,0]],[3,[0,0,90],[1,0,0,0],0,0,0]];
  VAR pos posCAM;
  VAR clock clock1;
  CONST robtarget psb_Pick:=[[900,-100,700],[0,0,1,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pIn:=[[150,100,250],[0,0,1,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  PROC main()
    rInitAll;
    WHILE TRUE DO
      IF SocketStr="startpress" THEN
        rPick;
      ELSEIF StrPart(SocketStr,1,4)="Upda" THEN
        rPick;
      ELSEIF diStart=1 OR TestDI(diManual) THEN
        rPick;
      ENDIF
      rCyclecheck;
      WaitTime 0.2;
    ENDWHILE
  ENDPROC
  PROC rInitAll()
    WHILE diSafetydoorOpen=1 DO
      TPErase;
      TPWrite "The Safe_Door is Opened"\Num:=nX;
      WaitDI diSafetydoorOpen,0;
    ENDWHILE
    StartMove;
    AccSet 50,50;
    IDelete iInit;
    CONNECT iInit WITH tInit;
    ISignalDI diRobReset,1,iInit;
    IDelete iInit;
    CONNECT iInit WITH tInit;
    ISignalDO\Single, doProcessFinish, 1, iInit;
  ENDPROC
  PROC rPick()
    SetDO DOPLC_Pick_Data_Req,1;
    MoveL psb_Pick, vMainFast, fine, tGrip\WObj:=wobj0;
    WaitDI DIPLC_Pick_Wr_Data_Finish,1\Visualize\Header:="Waiting for signal"\Message:="Wait write data Done"\Icon:=iconInfo;
    SetDO DOPLC_Pick_Data_Req,0;
    ClkReset clock1;
    ClkStart clock1;
GT_ReadAgain:
    wLoadin.oframe.trans.x:=0;
    posCAM.x:=AInput(AIPLC_X_Pos);
    posCAM.y:=AInput(AIPLC_y_Pos);
    posCAM.z:=AInput(AIPLC_z_Pos);
    IF (posCAM.x < 80) THEN
      TPWrite "Data position from PLC Error";
      GOTO GT_ReadAgain;
    ELSE
      ! TPErase;
    ENDIF
    IF posCAM.z > 350 THEN
      posCAM.z := 350;
    ENDIF
    IF posCAM.x < 110 THEN
      posCAM.x := 130;
    ENDIF
    wLoadin.oframe.trans.x:=(posCAM.x);
    MoveJ Offs(pIn,0,0,100),vMainFast,z50,tGrip\WObj:=wLoadin;
    MoveL pIn,v200,fine,tGrip\WObj:=wLoadin;
    Greifer\Zu\state:=Part;
    WaitUntil Spannbacke(\A\Auf);
    MoveL Offs(pIn,0,0,100),vMainFast,z50,tGrip\WObj:=wLoadin;
    ClkStop clock1;
    nX:=ClkRead(clock1\HighRes);
    TPWrite "Zeit "+NumToStr(nX,1)+"s";
  ENDPROC
  TRAP tInit
    StopMove;
    StorePath;
    MoveJ psb_Pick, v100, fine, tGrip;
    RestoPath;
    StartMove;
  ENDTRAP
ENDMODULE
