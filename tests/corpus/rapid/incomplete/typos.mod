MODULE 2_Typos_R1
    CONST robtarget Target_10:=[[900,0,700],[0,0,1,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        MoveJ Target_10,v1000,z100,tool0\WObj:=wobj0
        MoveL Offs(Target_10,0,0,-100),v200,fine,tool0;
        SetDO do1,1;
        FOR i FROM 1 TO 3 DO
          MoveL Offs(Target_10,0,i*50,-100),v200,fine,tool0
        ENDFOR
        TPWrite("Hello");
        WaitTime(1);
        counter = counter + 1;
        MoveL Target_10,v200,fine,tool0;
    ENDPROC
ENDMODULE