%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE PAL_LINIE3
    !***********************************************************
    !* Palettierzelle Linie 3        Fa. Bäcker & Söhne
    !* Robotertyp  : IRB 6640-180/2.55
    !* Letzte Änderung: 14.03.2016  K. Müller  - Stapelhöhe geändert
    !***********************************************************
    ! Werkzeug- und Werkstückdaten
    PERS tooldata tGreifer:=[TRUE,[[0,0,285],[1,0,0,0]],[38.5,[0,0,160],[1,0,0,0],0,0,0]];
    TASK PERS wobjdata wPalette:=[FALSE,TRUE,"",[[1150,-650,-350],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    TASK PERS wobjdata wBand:=[FALSE,TRUE,"",[[300,1350,250],[0.70710678,0,0,0.70710678]],[[0,0,0],[1,0,0,0]]];
    PERS loaddata ldKarton:=[12.5,[0,0,140],[1,0,0,0],0,0,0];
    TASK PERS loaddata ldLeer:=[0.01,[0,0,1],[1,0,0,0],0,0,0];

    ! Geschwindigkeiten
    CONST speeddata vLeer:=[1800,400,5000,1000];
    CONST speeddata vVoll:=[1200,250,5000,1000];
    CONST speeddata vAblage:=[350,120,5000,1000];
    ! Zonen
    CONST zonedata zWeg:=[FALSE,80,120,120,12,120,12];
    CONST zonedata zNah:=[FALSE,15,22.5,22.5,2.3,22.5,2.3];

    ! Stapelmuster: 4 Kartons je Lage, Versatz in mm, Drehung in Grad
    CONST num nKartons:=4;
    CONST num nLagen:=3;
    CONST num nHoehe:=160;
    CONST num nMuster{4,3}:=[[0,0,0],
                             [410,0,0],
                             [0,320,0],
                             [410,320,0]];
    VAR num nLage:=0;
    VAR num nKarton:=0;
    PERS num nZaehler:=0;      ! bleibt nach Netz-Aus erhalten
    PERS num nGesamt:=18452;
    VAR bool bStoerung:=FALSE;
    VAR intnum iNotAus;
    VAR clock clkTakt;
    VAR num nTakt;

    ! Punkte
    CONST jointtarget jGrund:=[[0,-15,25,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pVorBand:=[[200,60,520],[0,-0.34202,0.939693,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pBand:=[[200,60,95],[0,-0.34202,0.939693,0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pMitte:=[[1350,420,900],[0,-0.965926,0.258819,0],[0,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pPalette:=[[210.5,165.25,84],[0,-0.887011,0.461749,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pWarten:=[[1500,50,1050],[0,-0.939693,0.34202,0],[0,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

    PROC main()
        ! Hauptprogramm
        Initialisieren;
        Grundstellung;
        IF nZaehler<>0 THEN
            TPWrite "Angefangene Palette, Kartons: "\Num:=nZaehler;
        ENDIF
        FOR i FROM 1 TO nLagen DO
            nLage:=i;
            LageStapeln;
            Incr nZaehler;
        ENDFOR
        PaletteFertig;
        Grundstellung;
    ENDPROC

    PROC Initialisieren()
        AccSet 80,80;
        VelSet 100,5000;
        ConfJ\On;
        ConfL\Off;
        SingArea\Off;
        Reset doVakuum;
        Reset doPaletteVoll;
        SetGO goStatus,1;
        nZaehler:=0;
        bStoerung:=FALSE;
        IDelete iNotAus;
        CONNECT iNotAus WITH tNotAus;
        ISignalDI\Single,diTuerOffen,1,iNotAus;
        GripLoad ldLeer;
        TPErase;
        TPWrite "Palettierer bereit";
    ENDPROC

    PROC LageStapeln()
        FOR k FROM 1 TO nKartons DO
            nKarton:=k;
            ClkReset clkTakt;
            ClkStart clkTakt;
            Aufnehmen;
            Ablegen k,nLage;
            ClkStop clkTakt;
            nTakt:=ClkRead(clkTakt);
            TPWrite "Taktzeit [s]: "\Num:=nTakt;
        ENDFOR
    ENDPROC

    PROC Aufnehmen()
        ! auf Karton warten
        MoveJ pVorBand,vLeer,zWeg,tGreifer\WObj:=wBand;
        WaitDI diKartonDa,1\MaxTime:=60;
        MoveL Offs(pBand,0,0,120),vLeer,zNah,tGreifer\WObj:=wBand;
        MoveL pBand,vAblage,fine,tGreifer\WObj:=wBand;
        Set doVakuum;
        WaitTime 0.35;
        WaitUntil diVakuumOk=1\MaxTime:=2;
        GripLoad ldKarton;
        MoveL Offs(pBand,0,0,300),vVoll,zNah,tGreifer\WObj:=wBand;
    ERROR
        IF ERRNO=ERR_WAIT_MAXTIME THEN
            TPWrite "Kein Karton oder kein Vakuum!";
            Stop;
            RETRY;
        ENDIF
    ENDPROC

    PROC Ablegen(num nPlatz,num nEbene)
        VAR robtarget pAblage;
        VAR num nZ;
        nZ:=(nEbene-1)*nHoehe;
        pAblage:=Offs(pPalette,nMuster{nPlatz,1},nMuster{nPlatz,2},nZ);
        MoveJ pMitte,vVoll,zWeg,tGreifer;
        MoveJ Offs(pAblage,-30,-30,250),vVoll,zWeg,tGreifer\WObj:=wPalette;
        MoveL Offs(pAblage,-30,-30,40),vVoll,zNah,tGreifer\WObj:=wPalette;
        MoveL pAblage,vAblage,fine,tGreifer\WObj:=wPalette;
        Reset doVakuum;
        PulseDO\PLength:=0.5,doAbblasen;
        WaitTime 0.2;
        GripLoad ldLeer;
        MoveL Offs(pAblage,0,0,250),vLeer,zNah,tGreifer\WObj:=wPalette;
        MoveJ pMitte,vLeer,z100,tGreifer;
        nGesamt:=nGesamt+1;
    ENDPROC

    PROC PaletteFertig()
        MoveJ pWarten,vLeer,fine,tGreifer;
        Set doPaletteVoll;
        WaitDI diPaletteWeg,1;
        Reset doPaletteVoll;
        TPWrite "Palette fertig, gesamt: "\Num:=nGesamt;
    ENDPROC

    PROC Grundstellung()
        MoveAbsJ jGrund\NoEOffs,v1000,fine,tGreifer;
        Set doGrundstellung;
    ENDPROC

    TRAP tNotAus
        ! Schutztür geöffnet
        Reset doVakuum;
        bStoerung:=TRUE;
        TPWrite "Schutztür offen";
        Stop;
    ENDTRAP
ENDMODULE