%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE PALETT
  VAR num nrow:=0;
  PERS tooldata gripper:=[TRUE,[[0,0,175],[1,0,0,0]],[12,[0,0,100],[1,0,0,0],0,0,0]];
  CONST robtarget p1:=[[1200.5,300.1,900],[0,0.7071,0.7071,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget p2:=[[1200.5,-300.1,900],[0.0,0.7071,0.7071,0.0],[-1,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  VAR clock clk; 
  PROC main()
    !Huvudprogram, öppna grip
    ConfL\On; ConfJ\On; VelSet 100,1500;AccSet 60,60;
    ClkReset clk;ClkStart clk;
    Set do1;Reset do2;
    WHILE nrow<3 DO
      Pick;
      Place nrow;
      Incr nrow;
    ENDWHILE
    ClkStop clk;
    TPWrite "Cykel: "\Num:=ClkRead(clk);
    IF ClkRead(clk)>30 THEN Stop;
    ENDIF
  ENDPROC
  PROC Pick()
    MoveJ Offs(p1,0,0,200),v1500,z100,gripper;
    MoveL p1,v300,fine,gripper;
    WaitTime 0.3;
    MoveL Offs(p1,0,0,200),v1500,z100,gripper;
  ENDPROC
  PROC Place(num n\num h)
    IF Present(h)=FALSE THEN
      MoveJ Offs(p2,0,-n*100,200),v1500,z100,gripper;
    ELSE
      MoveJ Offs(p2,0,-n*100,h),v1500,z100,gripper;
    ENDIF
    SearchL\Stop,di3,p2act,Offs(p2,0,-n*100,-50),v50,gripper;
    MoveL Offs(p2,0,-n*100,200),v800,z50,gripper;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      TPReadFK reg1,"No box","Retry","","","","Stop";
      RETRY;
    ENDIF
  ENDPROC
  VAR robtarget p2act;
ENDMODULE
