MODULE Rec
  RECORD part_t
    string name;
    num h;
    robtarget pick;
    bool flip;
  ENDRECORD
  RECORD job_t
    part_t part;
    num count;
  ENDRECORD
  CONST robtarget p0:=[[650,-100,350],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR part_t parts{2}:=[["A",30,[[650,-100,350],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],FALSE],["B",50,[[650,100,350],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],TRUE]];
  VAR job_t job;
  ALIAS num length_mm;
  VAR length_mm up:=80;
  TASK PERS loaddata ld:=[3,[0,0,80],[1,0,0,0],0,0,0];
  PROC main()
    FOR i FROM Dim(parts,1) TO 1 STEP -1 DO
      job:=[parts{i},2];
      RunJob job \fast;
    ENDFOR
  ENDPROC
  PROC RunJob(VAR job_t j \switch fast | switch slow)
    VAR speeddata s;
    s:=v200;
    IF Present(fast) s:=[800,500,5000,1000];
    j.count:=j.count+1;
    WHILE j.count>0 DO
      MoveJ Offs(j.part.pick,0,0,up),s,z20,tool0;
      MoveL j.part.pick,v100\V:=80,fine,tool0;
      GripLoad ld;
      WaitUntil di1=1 OR di2=1\MaxTime:=3;
      MoveL Offs(j.part.pick,0,0,up+j.part.h),s,z20,tool0;
      IF j.part.flip THEN
        MoveJ RelTool(Offs(j.part.pick,0,0,up+j.part.h),0,0,0\Rz:=90),s,fine,tool0;
      ENDIF
      GripLoad load0;
      j.count:=j.count-2;
    ENDWHILE
  ENDPROC
ENDMODULE
