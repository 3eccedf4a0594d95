MODULE KamSort
  !==================================================================
  ! Kamera-Sortierzelle: Teile vom Förderer in zwei Kisten
  ! Übernommen von Anlage 2, Stückzähler läuft in der SPS mit !!
  !==================================================================
  TASK PERS tooldata tSauger:=[TRUE,[[0,0,85],[1,0,0,0]],[0.4,[0,0,40],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wKamera:=[FALSE,TRUE,"",[[420,-150,120],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
	PERS num nGut:=0;
	PERS num nSchlecht:=0;
  PERS bool bFreigabe:=FALSE;
  PERS bool bKisteVoll;
  PERS string stBefehl:="";
  VAR num nTeil := 0;
  VAr bool bZeit;
  VAR cameratarget ctTeil;
  VAR string stText;
  VAR num nKomma;
  CONST num nHoehe := 70;    ! Abstand ueber dem Teil
  CONST num nTeile:=4;
  CONST string stBilder{4}:=["gut,12,30","schlecht,-8,0","gut,0,15","leer"];
  CONST jointtarget jGrund:=[[0,0,0,0,90,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pKamera:=[[0,0,150],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pKiste1:=[[480,180,220],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pKiste2:=[[360,260,220],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST speeddata vLangsam:=[80,200,5000,1000];

!--------------------------------------------------------------
  ! Hauptprogramm (kein "main": startet über die SPS)
!--------------------------------------------------------------
  PROC KamSortMain()
    Vorbereiten;
    MoveAbsJ jGrund\NoEOffs,v800,z50,tSauger;
    WHILE nTeil<nTeile DO
      nTeil:=nTeil+1;
      ! warten bis die SPS bFreigabe setzt
      WaitUntil bFreigabe=TRUE AND stBefehl="START";
      IF NOT bFreigabe THEN
        TPWrite "nie";
        EXIT;
      ENDIF
      bFreigabe:=FALSE;
      stBefehl:="";
      SucheTeil;
    ENDWHILE
    MoveAbsJ jGrund\NoEOffs,v800,fine,tSauger;
    nTagesZaehler:=nGut+nSchlecht;!steht in der SPS-Task
    stPlcStatus.fertig:=TRUE;
    TPWrite "Fertig: "\Num:=nTagesZaehler;
  ERROR
    IF ERRNO=ERR_WAIT_MAXTIME THEN
      RETRY;
    ELSE
      RAISE ;
    ENDIF
  ENDPROC

  PROC Vorbereiten()
    ConfJ\Off;
    ConfL\Off;
    AccSet 80, 80;
    open;
    CamSetProgramMode camOben;
    CamLoadJob camOben,"sortieren.job";
    CamSetRunMode camOben;
    WaitTime(0.5);
    nGut:=0;  nSchlecht:=0;
  ENDPROC

  ! Vakuum: die alten Namen bleiben
  PROC open()
    PulseDO\High\PLength:=0.2,doBlasen;
    Reset doVakuum;
    WaitDI diVakuum,0,\MaxTime:=2,\TimeFlag:=bZeit;
    IF bZeit TPWrite"Vakuum noch da";
  ENDPROC
  PROC close()
    Set doVakuum;
    WaitDI diVakuum,1\Visualize\Header:="Sauger"\Message:="kein Vakuum"\Icon:=iconInfo;
  ENDPROC

  PROC SucheTeil()
    VAR bool bOk;
    VAR num nX:=0;
    VAR num nArt;
    CamReqImage camOben;
    CamGetResult camOben,ctTeil;
    stText:=stBilder{nTeil};
    nKomma:=StrFind(stText,1,",");
    IF nKomma>StrLen(stText) THEN
      TPWrite "kein Teil: "+stText;
      RETURN;
    ENDIF
    nArt:=Art(StrPart(stText,1,nKomma-1));
    stText:=StrPart(stText,nKomma+1,StrLen(stText)-nKomma);
    bOk:=StrToVal(StrPart(stText,1,StrFind(stText,1,",")-1),nX);
    IF bOk=FALSE OR Abs(nX)>50 THEN
      TPWrite "Kameradaten: "+stText;
    ELSE
      Hole nDx:=nX,nDrehung:=5*nTeil;
      TEST nArt
      CASE 1:
        Lege(pKiste1);
        nGut:=nGut+1;
      CASE 2,3: Lege pKiste2\vor:=v400; nSchlecht:=nSchlecht+1;
      DEFAULT:
      ENDTEST
    ENDIF
  ENDPROC

  FUNC num Art(string stName)
    IF stName="gut" RETURN 1;
    RETURN 2;
  ENDFUNC

  PROC Hole(num nDx,num nDrehung)
    MoveJ Offs(pKamera,nDx,0,nHoehe),v1000,z20,tSauger\WObj:=wKamera;
    MoveL RelTool(pKamera,-nDx,0,0\Rx:=0,\Ry:=0,\Rz:=nDrehung),vLangsam,fine,tSauger\WObj:=wKamera;
    close;
    MoveL Offs(pKamera,nDx,0,nHoehe),v300,z10,tSauger\WObj:=wKamera;
  ENDPROC

  PROC Lege(robtarget pZiel\speeddata vor)
    VAR speeddata vAb:=v600;
    IF Present(vor) vAb:=vor;
    MoveJ Offs(pZiel,0,0,90),vAb,z30,tSauger;
    MoveL pZiel,vLangsam,fine,tSauger\WObj:=wobj0;
    open ;
    MoveL Offs(pZiel,0,0,90),vAb,z30,tSauger;
    IF bKisteVoll = TRUE THEN
      Stop;!Kiste tauschen
    ENDIF
  ENDPROC
ENDMODULE