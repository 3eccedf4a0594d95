%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE aloitus
! Vuoron alku: nosta ensin siitä missä ollaan, sitten kotiin
VAR robtarget rNyt;
VAR num nNosto;
CONST jointtarget jKoti:=[[0,-15,20,0,70,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget pKiinni:=[[820,120,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
 ConfJ\Off; ConfL\Off;
 rNyt:=CRobT(\Tool:=tool0\WObj:=wobj0);
 nNosto:=1150-rNyt.trans.z;
 IF nNosto>0 MoveL Offs(rNyt,0,0,nNosto/4),v200,z10,tool0;
 MoveAbsJ jKoti,v500,fine,tool0;
 MoveJ Offs(pKiinni,0,0,100),v500,z20,tool0;
 MoveL pKiinni,v100,fine,tool0;
 Set doTarraa;
 MoveL Offs(pKiinni,0,0,100),v200,z20,tool0;
 MoveAbsJ jKoti,v500,fine,tool0;
ENDPROC
ENDMODULE