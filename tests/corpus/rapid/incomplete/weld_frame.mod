%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%

MODULE Cell_Weld(NOSTEPIN)
  PERS seamdata sm1:=[0.5,0.3,[0,0,0,0,0,0,0,0,0],0,0,0,0,0,[0,0,0,0,0,0,0,0,0],0,0,[0,0,0,0,0,0,0,0,0],0,0,[0,0,0,0,0,0,0,0,0],0.5];
  PERS welddata wd1:=[8,0,[5,0,22,0,9,0,0,0,0],[0,0,0,0,0,0,0,0,0]];
  PERS weavedata wv1:=[1,0,3,2,0,0,0,0,0,0,0,0,0,0,0];
  PERS tooldata tWeldGun:=[TRUE,[[12.5,0,371.3],[0.9239,0,0.3827,0]],[4.2,[-20,0,80],[1,0,0,0],0,0,0.03]];
  TASK PERS wobjdata wobj_fix:=[FALSE,TRUE,"",[[850,-250,420],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  LOCAL CONST robtarget pSafe:=[[200,100,350],[0.05,0.70,0.70,0.05],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
  LOCAL CONST robtarget pW{4}:=[[[0,0,0],[0.0,0.70711,0.70711,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
    [[100,0,0],[0.0,0.70711,0.70711,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
    [[150,50,0],[0.0,0.70711,0.70711,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
    [[100,100,0],[0.0,0.70711,0.70711,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]];
  VAR num nPasses:=2;
  VAR intnum intTorch;
  VAR triggdata tgGas;

  PROC Weld_Prog()
    VAR num a;
    MoveJ pSafe,v1000,z50,tWeldGun\WObj:=wobj_fix;
    TriggIO tgGas,0.2\Time\DOp:=doGas,1;
    FOR i FROM 1 TO nPasses DO
      TriggL RelTool(pW{1},0,0,-80),v500,tgGas,z10,tWeldGun\WObj:=wobj_fix;
      ArcLStart pW{1},v100,sm1,wd1,fine,tWeldGun\WObj:=wobj_fix\SeamName:="Naht_"+NumToStr(i,0);
      ArcL pW{2},v100,sm1,wd1\Weave:=wv1,z1,tWeldGun\WObj:=wobj_fix;
      ArcC pW{3},pW{4},v100,sm1,wd1\Weave:=wv1,z1,tWeldGun\WObj:=wobj_fix;
      ArcLEnd Offs(pW{4},-100,0,0),v100,sm1,wd1,fine,tWeldGun\WObj:=wobj_fix;
      MoveL RelTool(Offs(pW{4},-100,0,0),0,0,-80\Rx:=0\Ry:=10),vmax,z20,tWeldGun\WObj:=wobj_fix;
      a:=i*2;
    ENDFOR
    ArcRefresh;
    MoveJ pSafe,v1000,fine,tWeldGun\WObj:=wobj_fix;
    Incr nPasses;
  UNDO
    Reset doGas;
  ENDPROC

  TRAP trTorch
    StopMove;
    StorePath;
    MoveL Offs(CRobT(\Tool:=tWeldGun\WObj:=wobj_fix),0,0,50),v100,fine,tWeldGun\WObj:=wobj_fix;
    RestoPath;
    StartMove;
  ENDTRAP

  PROC main()
    ! init
    IDelete intTorch;
    CONNECT intTorch WITH trTorch;
    ISignalDI\Single,diTorchColl,1,intTorch;
    IWatch intTorch;
    rCleanTorch;
    Weld_Prog;
    IF diAuto=1 AND NOT (giJob=0) THEN
      %"Job"+ValToStr(giJob)%;
    ENDIF
    IDisable;
    ISleep intTorch;
  ENDPROC
ENDMODULE
