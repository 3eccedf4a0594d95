MODULE Paletizado_Cajas
  ! Celda de paletizado: garra y mesas están en CalibData.mod (no copiado)
  CONST robtarget pEspera:=[[850,60,700],[0,0,1,0],[0,-2,1,3],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pCoger:=[[700,-150,420],[0,0,1,0],[-3,2,-4,6],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST robtarget pDejar:=[[760,180,380],[0,0,1,0],[1,3,-2,7],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  CONST num nAncho:=90;
  VAR num nCaja:=0;
  VAR num nMenu;
  VAR bool bSeguir:=TRUE;
  PROC main()
    TPErase;
    TPReadFK nMenu,"¿Qué producto?","Caja","Saco",stEmpty,stEmpty,"Salir";
    MoveJ pEspera,v800,z50,tGarra\WObj:=wMesa1;
    WHILE bSeguir DO
      TomarCaja;
      PonerCaja;
      Incr nCaja;
      IF nCaja>=3 bSeguir:=FALSE;
    ENDWHILE
    MoveJ pEspera,v800,fine,tGarra\WObj:=wMesa1;
    IF nMenu=5 RETURN;
  ENDPROC
  PROC TomarCaja()
    MoveJ Offs(pCoger,0,0,150),v1000,z20,tGarra\WObj:=wMesa1;
    MoveL pCoger,v200,fine,tGarra\WObj:=wMesa1;
    Set doVacio;WaitTime .3;
    MoveL Offs(pCoger,0,0,150),v400,z20,tGarra\WObj:=wMesa1;
  ENDPROC
  PROC PonerCaja()
    MoveL Offs(pDejar,-nAncho*nCaja,0,150),v1000,z20,tGarra\WObj:=wMesa1;
    MoveL Offs(pDejar,-nAncho*nCaja,0,0),v150,fine,tGarra\WObj:=wMesa1;
    Reset doVacio;WaitTime .2;
    MoveL Offs(pDejar,-nAncho*nCaja,0,150),v600,z20,tGarra\WObj:=wMesa1;
  ENDPROC
ENDMODULE