MODULE Square
  ! A square of 200 mm for an IRB 6640-180/2.55, flange down, corners passed in zones.
  CONST jointtarget home := [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p1 := [[1300,100,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];

  PROC main()
    MoveAbsJ home, v1000, fine, tool0;
    MoveJ p1, v1000, fine, tool0;
    MoveL Offs(p1,200,0,0), v500, z50, tool0;
    MoveL Offs(p1,200,200,0), v500, z20, tool0;
    MoveL Offs(p1,0,200,0), v500, z10, tool0;
    MoveL p1, v500, fine, tool0;
    MoveAbsJ home, v1000, fine, tool0;
  ENDPROC
ENDMODULE
