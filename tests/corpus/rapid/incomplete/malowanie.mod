MODULE Malowanie
    PERS tooldata tPistolet:=[TRUE,[[0,0,200],[1,0,0,0]],[2.5,[0,0,80],[1,0,0,0],0,0,0]];
    PERS wobjdata wDrzwi:=[FALSE,TRUE,"",[[700,-250,350],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    CONST speeddata vMal:=[200,500,5000,1000];
    VAR triggdata trgOn;
    VAR triggdata trgOff;

    PROC Pasy(num szer,num wys,num co,num z)
        VAR num ile:=0;
        VAR num y:=0;
        VAR robtarget pOd;
        VAR robtarget pDo;
        ile:=Round(wys/co);
        ConfL\Off;
        ConfJ\Off;
        SingArea\Wrist;
        TriggIO trgOn,30\DOp:=doFarba,1;
        TriggIO trgOff,30\DOp:=doFarba,0;
        FOR i FROM 0 TO ile DO
            y:=i*co;
            IF i MOD 2=0 THEN
                pOd:=[[0,y,z],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                pDo:=[[szer,y,z],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
            ELSE
                pOd:=[[szer,y,z],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
                pDo:=[[0,y,z],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
            ENDIF
            MoveJ pOd,v500,fine,tPistolet\WObj:=wDrzwi;
            TriggL pDo,vMal,trgOn\T2:=trgOff,z1,tPistolet\WObj:=wDrzwi;
        ENDFOR
        SetDO doFarba,0;
    ENDPROC

    PROC main()
        IF diDrzwi=1 OR TaskRunMec() THEN
            Pasy 300,200,50,60;
        ENDIF
    ENDPROC
ENDMODULE