MODULE Lyssna
  RECORD order
    string how;
    pos at;
    orient turned;
  ENDRECORD
  VAR order oNu;
  VAR bool bKlar:=FALSE;
  VAR intnum iOrder;

  PROC main()
    ConfL\Off;
    CONNECT iOrder WITH TagEmot;
    IRMQMessage oNu,iOrder;
    WHILE bKlar=FALSE DO
      WaitTime 0.05;
    ENDWHILE
    TPWrite "klar";
    IDelete iOrder;
    EXIT;
  ENDPROC

  TRAP TagEmot
    VAR rmqmessage meddelande;
    VAR rmqheader huvud;
    RMQGetMessage meddelande;
    RMQGetMsgHeader meddelande\Header:=huvud;
    IF huvud.datatype="order" THEN
      RMQGetMsgData meddelande,oNu;
      IF oNu.how="L" THEN
        StorePath;
        MoveL [oNu.at,oNu.turned,[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0\WObj:=wobj0;
        RestoPath;
      ENDIF
    ENDIF
  ENDTRAP
ENDMODULE