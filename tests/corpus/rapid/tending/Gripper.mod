MODULE Gripper
  ! Pneumatics. \A or \B choose the finger pair
  LOCAL VAR num nTry:=0;

  PROC rGripper(\switch A|switch B,num nAction)
    IF Present(A) THEN
      IF nAction=GRIP_CLOSE THEN
        Reset doOpenA;
        Set doCloseA;
        WaitDI diClosedA,1\MaxTime:=1.5;
      ELSE
        Reset doCloseA;
        Set doOpenA;
      ENDIF
    ELSEIF Present(B) THEN
      IF nAction=GRIP_CLOSE THEN
        Reset doOpenB;
        Set doCloseB;
        WaitDI diClosedB,1\MaxTime:=1.5;
      ELSE
        Reset doCloseB;
        Set doOpenB;
      ENDIF
    ENDIF
    WaitTime 0.15;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      nTry:=nTry+1;
      IF nTry<3 RETRY;
      nTry:=0;
      TPWrite "gripper does not close";
      TRYNEXT;
    ENDIF
  ENDPROC

  FUNC bool bPartInA()
    RETURN (DInput(diClosedA)=1) AND (DInput(diPartA)=1);
  ENDFUNC
ENDMODULE