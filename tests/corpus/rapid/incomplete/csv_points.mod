MODULE Parse
  CONST string csv:="100.5,200,-3;10,20,30";
  VAR string part; VAR num idx; VAR pos p3; VAR bool ok; VAR orient or1;
  CONST robtarget base:=[[600,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget rts{3};
  VAR string tx{3}:=["[10,0,0]","[0,20,0]","[5,5,5]"];
  PROC main()
    rts:=[base,base,base];
    FOR i FROM 1 TO 3 DO
      ok:=StrToVal(tx{i},p3);
      IF ok THEN
        rts{i}.trans:=base.trans+p3*3;
      ELSE
        TPWrite "bad "+tx{i};
      ENDIF
      MoveL rts{i},v100,z1,tool0;
    ENDFOR
    idx:=StrMatch(csv,1,";");
    part:=StrPart(csv,1,idx-1);
    IF StrLen(part)=12 OR part="x" TPWrite part;
    ok:=StrToVal(StrPart(part,1,StrFind(part,1,",")-1),reg1);
    MoveJ Offs(base,reg1,0,50),v500,fine,tool0;
    or1:=OrientZYX(45,0,180);
    MoveL [base.trans,or1,base.robconf,base.extax],v200,fine,tool0\WObj:=wobj0;
    TPWrite ByteToStr(65\Char)+ValToStr(base.rot)+NumToStr(Pow(2,3)+Sqrt(4)-Trunc(2.7)+Round(2.55\Dec:=1),2);
    IF StrOrder("a","b",STR_UPPER) AND NOT StrMemb("abc",2,"xyz") THEN
      MoveJ base,v500,fine,tool0;
    ENDIF
    reg2:=StrToByte("FF"\Hex);
    IF BitCheck(byteX,3) BitSet byteX,2;
    byteX:=BitAnd(3,5);
  ENDPROC
  VAR byte byteX:=7;
ENDMODULE
