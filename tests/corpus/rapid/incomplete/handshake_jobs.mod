MODULE HandshakeJobs
  VAR num nJob; VAR num nOld:=-1; VAR byte bIn;
  PERS bool bReady:=FALSE;
  LOCAL CONST robtarget pA:=[[700,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  LOCAL CONST robtarget pB:=[[700,250,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    SetGO goState,0;
    MoveJ pA,v300,fine,tool0;
    again:
    nJob:=GInput(giJob);
    IF nJob=nOld THEN
      WaitTime 0.02;
      GOTO again;
    ENDIF
    WaitUntil diStrobe=1 AND (nJob>0 OR diForce=1)\PollRate:=0.05;
    SetDO doAck,1;
    WaitDI diStrobe,0;
    SetDO doAck,0;
    CallByVar "Job",nJob;
    nOld:=nJob;
    GOTO again;
  ENDPROC
  PROC Job1()
    MoveL pB,v200,z10,tool0;
    MoveL pA,v200,fine,tool0;
  ENDPROC
  PROC Job2()
    MoveL Offs(pB,0,0,100),v200,z10,tool0;
    MoveL pA,v200,fine,tool0;
  ENDPROC
ENDMODULE
