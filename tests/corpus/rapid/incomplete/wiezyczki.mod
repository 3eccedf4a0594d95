MODULE Wiezyczki
    CONST robtarget pOdbior:=[[600,-150,420],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pStos1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pStos2:=[[600,250,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget jDom:=[[0,-10,10,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    VAR num nGrubosc:=20;
    VAR num nStos1:=0;
    VAR num nStos2:=0;
    VAR num nKtory:=0;
    VAR robtarget pTymczasowy;

    PROC main()
        Reset;
        FOR m FROM 0 TO 4 DO
            WaitDO do_gotowy,1;
            ConfL\Off;
            TEST m
            CASE 0,1:
                nKtory:=1;
                PulseDO\High\PLength:=1,do_takt;
                Bierz(pOdbior);
                Odloz pStos1,nStos1;
                nStos1:=nStos1+nGrubosc;
            CASE 2,3:
                nKtory:=2;
                Bierz(pOdbior);
                Odloz pStos2,nStos2;
                nStos2:=nStos2+nGrubosc;
            DEFAULT:
                TPWrite "zly wybor "\Num:=m;
            ENDTEST
        ENDFOR
        MoveAbsJ jDom,v500,z100,ssawka\WObj:=wobj0;
    ENDPROC

    PROC Reset()
        MoveAbsJ jDom,vmax,fine,ssawka\WObj:=stol;
        SetDO do_ssij,0;
    ENDPROC

    PROC Bierz(robtarget pGdzie)
        MoveJ Nad(pGdzie,0),v500,z10,ssawka\WObj:=stol;
        MoveL pGdzie,v50,fine,ssawka\WObj:=stol;
        SetDO do_ssij,1;
        WaitTime\InPos,0.5;
        MoveL Nad(pGdzie,0),v500,z10,ssawka\WObj:=stol;
    ENDPROC

    PROC Odloz(robtarget pGdzie,num nWysoko)
        MoveJ Nad(pGdzie,nWysoko),v500,z10,ssawka\WObj:=stol;
        MoveL Offs(pGdzie,0,0,nWysoko),v50,fine,ssawka\WObj:=stol;
        SetDo do_ssij,0;
        WaitTime\InPos,0.5;
        MoveL Nad(pGdzie,nWysoko),v500,z10,ssawka\WObj:=stol;
    ENDPROC

    FUNC robtarget Nad(robtarget pGdzie,num nWysoko)
        pTymczasowy:=Offs(pGdzie,0,0,nWysoko+60);
        RETURN pTymczasowy;
    ENDFUNC
ENDMODULE