MODULE Glue
 VAR triggdata tOn; VAR triggdata tOff; VAR triggdata tSpd; VAR triggios gunon{2};
 VAR intnum i1;
 VAR restartdata rd;
 PERS tooldata tGun:=[TRUE,[[0,0,200],[1,0,0,0]],[2,[0,0,100],[1,0,0,0],0,0,0]];
 CONST robtarget p0:=[[700,0,500],[0,0.5,0.866,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
 PROC main()
  VAR robtarget p; VAR pose pe; VAR orient o; VAR num i; VAR pos v3;
  gunon{1}.used:=TRUE; gunon{1}.distance:=3; gunon{1}.start:=TRUE; gunon{1}.signalname:="doGun"; gunon{1}.equiplag:=0; gunon{1}.setvalue:=1; gunon{1}.xxx:=0;
  CONNECT i1 WITH trp;
  TriggEquip tOn,10,0.05\DOp:=doGun,1;
  TriggEquip tOff,0,0.05\DOp:=doGun,0;
  TriggInt tSpd,5,i1;
  TriggStopProc rd\DO1:=doGun\GO1:=goX,doShadow;
  MoveJ p0,vmax,fine,tGun;
  p:=p0;
  FOR k FROM 0 TO 360 STEP 30 DO
    p.trans:=p0.trans+[100*Cos(k),100*Sin(k),0];
    TriggL p,v200\T2:=tOff,tOn,z5,tGun;
  ENDFOR
  FOR k FROM 5 TO 1 STEP -2 DO
    TriggJ Offs(p,0,0,k*10),v500,tOff,z10,tGun;
  ENDFOR
  TriggLIOs p0,v500\TriggData1:=gunon,z10,tGun;
  pe:=PoseMult([[100,0,0],[1,0,0,0]],PoseInv([[0,20,0],OrientZYX(10,0,0)]));
  PDispSet pe;
  MoveL p0,v500,fine,tGun;
  PDispOff;
  PDispOn\Rot\ExeP:=p0,p0,tGun;
  EOffsOff;
  v3:=pe.trans*2-[1,2,3];
  i:=VectMagn(v3); o:=NOrient([0.1,0.7,0.7,0.1]);
  p.rot:=p.rot*o;
  MoveL Offs(p0,i/100,0,0),v500,fine,tGun;
 ENDPROC
 TRAP trp
  reg1:=reg1+1;
  TPWrite "x"\Num:=reg1;
 ENDTRAP
ENDMODULE
