MODULE Teleop
  VAR socketdev sckServer;
  VAR socketdev sckClient;
  VAR rawbytes rbIn;
  VAR num nCommand;
  VAR num nValues{12};
  VAR robtarget pGoal;
  CONST jointtarget jRest:=[[0,-15,30,0,55,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  FUNC bool Reachable(robtarget p)
    VAR jointtarget j;
    j:=CalcJointT(p,tool0);
    RETURN TRUE;
  ERROR
    RETURN FALSE;
  ENDFUNC

  PROC main()
    SocketCreate sckServer;
    SocketBind sckServer,"192.168.125.1",6400;
    SocketListen sckServer;
    SocketAccept sckServer,sckClient\Time:=WAIT_MAX;
    WHILE TRUE DO
      SocketReceive sckClient\RawData:=rbIn;
      UnpackRawBytes rbIn,1,nCommand\IntX:=UINT;
      FOR i FROM 1 TO Dim(nValues,1) DO
        UnpackRawBytes rbIn,3+4*(i-1),nValues{i}\Float4;
      ENDFOR
      TEST nCommand
      CASE 10:
        pGoal:=[[nValues{1},nValues{2},nValues{3}],[nValues{4},nValues{5},nValues{6},nValues{7}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
        IF Reachable(pGoal) MoveL pGoal,v200,fine,tool0;
      CASE 20:
        MoveAbsJ jRest\NoEOffs,v300,fine,tool0;
      CASE 99:
        SocketClose sckClient;
        RETURN;
      ENDTEST
    ENDWHILE
  ERROR
    IF ERRNO=ERR_SOCK_CLOSED RETRY;
  ENDPROC
ENDMODULE
