MODULE AgvDispatch
  TASK PERS tooldata Servo:=[TRUE,[[0,0,114.2],[1,0,0,0]],[0.262,[7.8,11.9,50.7],[1,0,0,0],0.00022,0.00024,0.00009]];
  PERS num container_offset:=60;
  CONST robtarget Home_agv:=[[700,0,600],[0.000001,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget ContainerFrontPos:=[[0,0,0],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget ContainerBuffer:=[[200,200,0],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  TASK PERS wobjdata Buffer:=[FALSE,TRUE,"",[[700,-300,200],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  VAR triggdata trOn;
  VAR triggdata trOff;
  VAR string received_string;
  VAR socketdev server_socket;
  VAR socketdev client_socket;
  VAR bool ok;
  VAR num queue{3,2}:=[[0,0],[50,60],[100,20]];
  RECORD job
    string name;
    num count;
    robtarget at;
  ENDRECORD
  VAR job jobs{4};
  VAR intnum err_int;
  PROC main()
    VAR num i:=1;
    jobs{1}:=["A",2,ContainerFrontPos];
    jobs{2}.name:="B";
    jobs{2}.at:=Offs(ContainerFrontPos,100,0,0);
    TriggIO trOn, 10 \DOp:=doGlue, 1;
    TriggEquip trOff, 20, 0.1 \DOp:=doGlue, 0;
    SocketCreate server_socket;
    SocketBind server_socket,"192.168.125.1",1025;
    SocketListen server_socket;
    SocketAccept server_socket,client_socket\Time:=WAIT_MAX;
    WHILE i<=3 DO
      SocketReceive client_socket\Str:=received_string\Time:=WAIT_MAX;
      SocketSend client_socket\Str:="OK"+ValToStr(i);
      TEST received_string
      CASE "1","pick":
        ContainerSwitcheroo 1;
      CASE "2":
        ContainerSwitcheroo i\Fast;
      DEFAULT:
        TPWrite "unknown "+received_string;
        ContainerSwitcheroo 2;
      ENDTEST
      i:=i+1;
    ENDWHILE
    FOR k FROM 1 TO Dim(queue,1) DO
      TriggL Offs(ContainerBuffer,queue{k,1},queue{k,2},50), v300, trOn\T2:=trOff, z5, Servo\WObj:=Buffer;
    ENDFOR
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs, v1000, fine, tool0;
    SocketClose client_socket;
  ERROR
    IF ERRNO=ERR_SOCK_CLOSED OR ERRNO=ERR_SOCK_TIMEOUT THEN
      RETRY;
    ELSE
      TRYNEXT;
    ENDIF
  ENDPROC
  PROC ContainerSwitcheroo(intnum i\switch Fast)
    VAR speeddata v;
    IF Present(Fast) THEN
      v:=v2000;
    ELSE
      v:=v500;
    ENDIF
    i:=i-1;
    MoveJ Home_agv,v,z100,Servo\WObj:=wobj0;
    MoveJ OFFS(ContainerFrontPos,container_offset*i,0,200),v,z100,Servo\WObj:=Buffer;
    MoveL OFFS(ContainerFrontPos,container_offset*i,0,0),v,fine,Servo\WObj:=Buffer;
    WaitTime \InPos, 0.2;
    g_GripIn\holdForce:=12;
    SetDO\SDelay:=0.2, doValve1, 1;
    PulseDO\High\PLength:=0.2, doValve2;
    MoveLDO OFFS(ContainerFrontPos,container_offset*i,0,100),v,z20,Servo\WObj:=Buffer, doValve1, 0;
    MoveJ RelTool(ContainerBuffer,0,0,-200\Rz:=45),v,z100,Servo\WObj:=Buffer;
    reg1:=GInput(giType);
    SetGO goType,reg1;
    %"rTyp"+NumToStr(reg1,0)%;
    CallByVar "rSub",2;
  ENDPROC
  PROC rSub2()
    MoveL ContainerBuffer,v100,fine,Servo\WObj:=Buffer;
  ENDPROC
ENDMODULE
