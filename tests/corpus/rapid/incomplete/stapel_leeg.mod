MODULE StapelLeeg
  ! laatste vak van het magazijn: de lus loopt er een te ver
  CONST robtarget pVak:=[[780,-250,450],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS num nHoogte{4}:=[0,22.5,45,67.5];
  VAR num n;
  PROC main()
    ConfL\Off;
    MoveJ Offs(pVak,0,0,200),v500,z10,tool0;
    FOR n FROM 1 TO 5 DO
      VakLeeg n;
    ENDFOR
    MoveJ Offs(pVak,0,0,200),v500,fine,tool0;
  ENDPROC
  PROC VakLeeg(num i)
    MoveL Offs(pVak,0,120*(i-1),60+nHoogte{i}),v400,z5,tool0;
    MoveL Offs(pVak,0,120*(i-1),nHoogte{i}),v100,fine,tool0;
    WaitTime 0.25;
    MoveL Offs(pVak,0,120*(i-1),60+nHoogte{i}),v400,z5,tool0;
  ENDPROC
ENDMODULE