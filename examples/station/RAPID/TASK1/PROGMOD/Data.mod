MODULE Data
  PERS tooldata tGrip:=[TRUE,[[0,0,80],[1,0,0,0]],[0.8,[0,0,40],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
ENDMODULE
