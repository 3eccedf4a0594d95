MODULE Rozkazy
  ! rozkazy daje drugie zadanie: jego modulu tu nie ma
  CONST robtarget pDom:=[[600,0,600],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pSkan:=[[550,200,550],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS tooldata tReka:=[TRUE,[[0,0,120],[1,0,0,0]],[0.8,[0,0,40],[1,0,0,0],0,0,0]];
  VAR speeddata vJazda:=[200,500,5000,1000];

  PROC main()
    ruch_gotowy:=FALSE;
    MoveJ pDom,v500,fine,tReka;
    WHILE TRUE DO
      WaitUntil wspolne.jest=TRUE \PollRate:=0.01;
      vJazda:=[predkosc,500,5000,1000];
      TEST wspolne.rozkaz
      CASE ROZ_DOM:
        MoveJ pDom,v500,fine,tReka;
      CASE ROZ_SKAN:
        MoveJ pSkan,v500,z20,tReka;
        Obejdz 3,vJazda;
      CASE ROZ_BLAD:
        TPWrite("BLAD");
        StopMove;
        STOP;
      ENDTEST
      gdzie_teraz:=CRobT(\Tool:=tReka);
      wspolne.jest:=FALSE;
    ENDWHILE
  ENDPROC

  PROC Obejdz(num ile,speeddata v)
    FOR k FROM 1 TO ile DO
      MoveL Offs(pSkan,0,-40*k,0),v200,z5,tReka;
    ENDFOR
  ENDPROC
ENDMODULE