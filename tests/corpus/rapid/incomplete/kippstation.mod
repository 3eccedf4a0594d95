MODULE Kippstation(SYSMODULE)
 !Tisch STN1 steht waehrend der ganzen Naht, Achsen 8 und 9
 PERS tooldata tBrenner:=[TRUE,[[20,0,330],[0.92388,0,0.382683,0]],[3.5,[0,0,90],[1,0,0,0],0,0,0]];
 TASK PERS wobjdata wTeil:=[FALSE,FALSE,"STN1",[[700,0,350],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
 CONST robtarget pVor:=[[-60,-120,160],[0,0.707107,0.707107,0],[0,0,0,0],[9E9,30,-90,9E9,9E9,9E9]];
 CONST robtarget pA:=[[-60,-120,40],[0,0.707107,0.707107,0],[0,0,0,0],[9E9,30,-90,9E9,9E9,9E9]];
 CONST robtarget pB:=[[-60,120,40],[0,0.707107,0.707107,0],[0,0,0,0],[9E9,30,-90,9E9,9E9,9E9]];
 PROC main( )
  ActUnit STN1;
  ConfJ\Off;ConfL\Off;
  MoveJ pVor,v500,z10,tBrenner\WObj:=wTeil;
  ArcLStart pA,v200,smNaht,wdKehl,fine,tBrenner\WObj:=wTeil;
  ArcLEnd pB,v20,smNaht,wdKehl,fine,tBrenner\WObj:=wTeil;
  MoveL Offs(pB,0,0,120),v300,fine,tBrenner\WObj:=wTeil;
  DeactUnit STN1;
 ENDPROC
ENDMODULE