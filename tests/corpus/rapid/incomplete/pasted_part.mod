VAR robtarget p1 := [[900,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
    MoveJ p1, v500, z10, tool0;
    MoveL Offs(p1,0,100,0), v500, fine, tool0;
ENDPROC
