MODULE Auftrag
  ! Der Leitrechner schreibt den Auftrag ueber PC-SDK in die Struktur
  RECORD auftragdaten
    num nummer;
    num platz;
    bool fertig;
    string text;
  ENDRECORD
  PERS auftragdaten auftrag:=[0,1,TRUE,""];
  PERS bool belegt{4}:=[FALSE,FALSE,FALSE,FALSE];
  CONST jointtarget jGrund:=[[0,-20,20,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pHol:=[[720,-220,520],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pAb:=[[720,240,520],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ jGrund,v1000,fine,tool0;
    WHILE TRUE DO
      IF auftrag.nummer=3 AND NOT auftrag.fertig THEN
        rTransport;
        belegt{auftrag.platz}:=TRUE;
        auftrag.fertig:=TRUE;
      ELSEIF auftrag.nummer=99 THEN
        GOTO wartung;
      ENDIF
      WaitTime 0.1;
    ENDWHILE
  ENDPROC
  PROC rTransport()
    MoveJ Offs(pHol,0,0,120),v1000,z20,tool0;
    MoveL pHol,v100,fine,tool0;
    Set doVakuum;
    WaitTime 0.3;
    MoveL Offs(pHol,0,0,120),v500,z20,tool0;
    MoveJ Offs(pAb,0,60*(auftrag.platz-1),120),v1000,z20,tool0;
    MoveL Offs(pAb,0,60*(auftrag.platz-1),0),v100,fine,tool0;
    Reset doVakuum;
    MoveL Offs(pAb,0,60*(auftrag.platz-1),120),v500,z20,tool0;
  ENDPROC
ENDMODULE
