MODULE PlcJobs
  ! Aufträge der SPS, Zelle 7 (Müller, März 2009)
  VAR num nJob;
  VAR string stProc;
  VAR clock clkCycle;
  VAR num nTime;
  VAR intnum intStop;
  VAR intnum intReq;
  CONST string stJobs{3}:=["Job_Load","Job_Turn","Job_Unload"];
  PERS tooldata tG1:=[TRUE,[[0,0,140],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wFix:=[FALSE,TRUE,"",[[450,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,-20,30,0,75,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  PROC main()
    Init_All;
        parkPlc;
    Home_Check;
    Next_Job:
    SetDO do_Ready,1;
    WaitUntil (di_Start=1 AND di_Auto=1) OR di_Service=1;
    SetDO do_Ready,0;
    nJob:=GInput(gi_JobNo);
    SetGO go_JobEcho,nJob;
    IF di_Service=1 THEN
      Service;
      GOTO Next_Job;
    ENDIF
    ClkReset clkCycle;
    ClkStart clkCycle;
    TEST nJob
    CASE 1,2,3:
      stProc:=stJobs{nJob};
      %stProc%;
    CASE 10:
      Job_Load;
      Job_Unload;
    CASE 99:
      Service;
    DEFAULT:
      SetDO do_Fault,1;
      ErrWrite "Unknown job","PLC sent job "+NumToStr(nJob,0);
      Stop;
    ENDTEST
    ClkStop clkCycle;
    nTime:=ClkRead(clkCycle);
    TPWrite "cycle "\Num:=nTime;
    SetDO do_Done,1;
    WaitDI di_Ack,1;
    SetDO do_Done,0;
    WaitDI di_Ack,0;
    GOTO Next_Job;
  ENDPROC
  PROC Init_All()
    IDelete intStop;
    CONNECT intStop WITH TrapStop;
    ISignalDI\Single,di_Stop,1,intStop;
    IDelete intReq;
    CONNECT intReq WITH TrapReq;
    ISignalGI gi_JobNo,intReq;
    ITimer 5,intReq;
    Reset do_Done; Reset do_Fault;
    ConfJ\Off; ConfL\Off;
    AccSet 80,80;
    VelSet 100,1500;
  ENDPROC
  PROC Home_Check()
    VAR jointtarget j;
    j:=CJointT();
    IF Abs(j.robax.rax_1-jHome.robax.rax_1)>0.1 OR Abs(j.robax.rax_5-jHome.robax.rax_5)>0.1 THEN
      UIMsgBox "Robot is not at home"\MsgLine2:="Go there?"\Buttons:=btnOKCancel\Result:=nRes;
      IF nRes=resCancel EXIT;
      MoveAbsJ jHome,v50,fine,tG1;
    ENDIF
  ENDPROC
  VAR btnres nRes;
  PROC Job_Load()
    MoveJ Offs(pLoad,0,0,150),v1000,z50,tG1\WObj:=wFix;
    MoveL pLoad,v200,fine,tG1\WObj:=wFix;
    Grip TRUE;
    MoveL Offs(pLoad,0,0,150),v1000,z50,tG1\WObj:=wFix;
  ENDPROC
  PROC Job_Turn()
    MoveJ RelTool(pLoad,0,0,-150\Rz:=45),v1000,z50,tG1\WObj:=wFix;
  ENDPROC
  PROC Job_Unload()
    MoveJ Offs(pLoad,0,100,150),v1000,z50,tG1\WObj:=wFix;
    Grip FALSE;
  ENDPROC
  PROC Service()
    MoveAbsJ jHome,v100,fine,tG1;
    Stop\NoRegain;
  ENDPROC
  PROC Grip(bool bClose)
    IF bClose THEN
      SetDO do_Grip,1;
    ELSE
      SetDO do_Grip,0;
    ENDIF
    WaitTime 0.2;
  ENDPROC
  TRAP TrapStop
    StopMove\Quick;
    StorePath;
    WaitDI di_Stop,0;
    RestoPath;
    StartMove;
  ENDTRAP
  TRAP TrapReq
    nJob:=GInput(gi_JobNo);
    SetGO go_JobEcho,nJob;
  ENDTRAP
  CONST robtarget pLoad:=[[0,-50,40],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkPlc:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkPlc()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG1;
        MoveAbsJ jparkPlc\NoEOffs,v500,z20,tG1;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tG1\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tG1;
        MoveL pHere,v20,fine,tG1;
        WaitTime 1.5;
    ENDPROC
ENDMODULE