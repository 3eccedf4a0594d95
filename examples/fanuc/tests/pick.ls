/PROG  PICK
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "a; b";
TCD:  STACK_SIZE	= 0,
      TASK_PRIORITY	= 50;
DEFAULT_GROUP	= 1,*,*,*,*;
/APPL
/MN
   1:  !Pick it; now ;
   2:  UFRAME_NUM=0 ;
   3:  UTOOL_NUM=1 ;
   4:  OVERRIDE=50% ;
   5:  R[1:counter]=0    ;
   6:J P[1:home] 100% FINE    ;
   7:  LBL[1] ;
   8:L P[2] 500mm/sec CNT50 ACC80    ;
   9:L P[2] R[9:speed]mm/sec CNT100 Offset,PR[2:off]    ;
  10:C P[3]    
    :  P[4] 300mm/sec CNT100 TB    .20sec,DO[1]=ON    ;
  11:  R[1:counter]=R[1:counter]+1    ;
  12:  IF R[1:counter]<2,JMP LBL[1] ;
  13:  FOR R[2]=1 TO 2 ;
  14:L P[2] 500mm/sec FINE    ;
  15:J P[1:home] 20% CNT10 DB 50.0mm,CALL GRIP    ;
  16:  ENDFOR ;
  17:  SELECT R[2]=1,JMP LBL[7] ;
  18:         =3,CALL GRIP ;
  19:         ELSE,JMP LBL[7] ;
  20:  IF (DI[3:part]=ON AND !DI[4]) THEN ;
  21:  DO[2]=ON ;
  22:  ELSE ;
  23:  DO[2]=OFF ;
  24:  ENDIF ;
  25:  WAIT   1.00(sec) ;
  26:  WAIT DI[1]=ON TIMEOUT,LBL[7] ;
  27:  PAYLOAD[2] ;
  28:  LBL[7] ;
  29:  END ;
/POS
P[1:"home"]{
   GP1:
	UF : 0, UT : 1,	
	J1=     0.000 deg,	J2=    10.000 deg,	J3=   -20.000 deg,
	J4=     0.000 deg,	J5=   -60.000 deg,	J6=     0.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =      .000  mm,	Z =   100.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[3]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   420.000  mm,	Y =    20.000  mm,	Z =   100.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
P[4]{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X =   400.000  mm,	Y =    40.000  mm,	Z =   100.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =     0.000 deg
};
/END
