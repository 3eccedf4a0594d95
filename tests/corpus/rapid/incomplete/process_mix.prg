%%%
 VERSION:1
 LANGUAGE:ENGLISH
%%%

MODULE ProcessMix
 PERS seamdata sm1:=[0.2,0.05,[0,0,0,0,0,0,0,0,0],0,0,0,0,0,[0,0,0,0,0,0,0,0,0],0,0,[0,0,0,0,0,0,0,0,0],0,0,[0,0,0,0,0,0,0,0,0],0.1,0,[0,0,0,0,0,0,0,0,0],0.5];
 PERS welddata wd1:=[8,0,[5,0,0,24,0,0,180,0,0],[0,0,0,0,0,0,0,0,0]];
 PERS weavedata wv1:=[1,0,3,2,0,0,0,0,0,0,0,0,0,0,0];
 PERS tooldata tTorch:=[TRUE,[[35,0,320],[0.9239,0,0.3827,0]],[3.5,[0,0,120],[1,0,0,0],0,0,0]];
 CONST robtarget s10:=[[900,-200,500],[0,0.3827,0.9239,0],[-1,-1,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
 CONST robtarget s20:=[[900,0,500],[0,0.3827,0.9239,0],[0,-1,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
 CONST robtarget s30:=[[900,100,500],[0,0.3827,0.9239,0],[0,-1,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
 VAR robtarget sFound;
 CONST robtarget s40:=[[950,150,500],[0,0.3827,0.9239,0],[0,-1,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
 PROC main()
  ConfL\Off;
  ConfJ\Off;
  ActUnit STN1;
  MoveJ Offs(s10,0,0,100),v1000,z50,tTorch;
  ArcLStart s10,v200,sm1,wd1\Weave:=wv1,fine,tTorch\SeamName:="Seam_1";
  ArcL s20,v200,sm1,wd1\Weave:=wv1,z1,tTorch\SeamName:="Seam_1";
  ArcC s30,s40,v200,sm1,wd1\Weave:=wv1,z1,tTorch;
  ArcLEnd Offs(s40,50,0,0),v200,sm1,wd1,fine,tTorch;
  MoveL Offs(s40,50,0,150),v500,z10,tTorch;
  SearchL\Stop, diTouch, sFound, s30, v50, tTorch;
  SpotL s10, v500, spot1, gun1, tTorch;
  SpotL\Conc,s20,vmax,gun1,spot3,tTorch\WObj:=wobj0;
  DispL \On, s30, v300, bead1, z5, tTorch;
  DispC s40, Offs(s40,30,30,0), v300, bead1, z5, tTorch;
  DispL \Off, Offs(s40,60,0,0), v300, bead1, fine, tTorch;
  PaintL s10,v500,z10,tTorch;
  WaitWObj wcnv1\RelDist:=100;
  MoveL Offs(s20,0,0,40),v500,z10,tTorch\WObj:=wobj0;
  DropWObj wcnv1;
  ArcKill;
  DeactUnit STN1;
  Stop;
  EXIT;
 ENDPROC
ENDMODULE