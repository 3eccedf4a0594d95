MODULE Wrapper
    PERS tooldata tG:=[TRUE,[[0,0,140],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    PERS wobjdata wT:=[FALSE,TRUE,"",[[400,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    VAR num nMoves:=0;
    CONST robtarget p1:=[[50,0,150],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC main()
        VAR robtarget pts{4};
        VAR jointtarget jt;
        VAR pose fr;
        VAR num aa{3,2}:=[[1,2],[3,4],[5,6]];
        ConfL\Off; ConfJ\Off;
        MoveLin p1,v200,z10,tG\WObj:=wT;
        MoveLin Offs(p1,50,0,0),v200,z10,tG\WObj:=wT;
        FOR i FROM 1 TO 4 DO
            pts{i}:=RelTool(p1,50*Cos(90*i),50*Sin(90*i),-20*i\Rz:=i*10);
        ENDFOR
        drivePath pts,v100\WObj:=wT\Back;
        jt:=CalcJointT(p1,tG\WObj:=wT);
        jt.robax.rax_6:=jt.robax.rax_6+10;
        MoveAbsJ jt\NoEOffs,v200,fine,tG\WObj:=wT;
        fr:=DefFrame(pts{1},pts{2},pts{3}\Origin:=1);
        TPWrite ArgOf(pts);
        showSum aa;
        swapEm aa{1,1},aa{3,2};
        MoveL Offs(p1,aa{1,1}*10,aa{3,2}*10,0),v200,fine,tG\WObj:=wT;
        PDispSet [[0,0,30],[1,0,0,0]];
        MoveL p1,v200,fine,tG\WObj:=wT;
        PDispOff;
        PDispOn\Rot\ExeP:=Offs(p1,0,0,20),p1,tG\WObj:=wT;
        MoveL p1,v200,fine,tG\WObj:=wT;
        PDispOff;
        MoveC Offs(p1,30,30,0),Offs(p1,60,0,0),v100,z5,tG\WObj:=wT;
        MoveL RelTool(p1,0,0,0\Rx:=5\Ry:=-5),v200,fine,tG\WObj:=wT\TLoad:=load0;
        parkWr;
    ENDPROC
    FUNC string ArgOf(INOUT robtarget p{*})
        RETURN ArgName(p)+" "+Type(p);
    ENDFUNC
    PROC MoveLin(robtarget p,speeddata v,zonedata z,PERS tooldata t\PERS wobjdata WObj\switch NoCount)
        IF NOT Present(NoCount) nMoves:=nMoves+1;
        MoveL p,v,z,t\WObj?WObj;
    ENDPROC
    PROC drivePath(robtarget pt{*},speeddata v,\PERS wobjdata WObj|num dummy,\switch Back)
        FOR i FROM 1 TO Dim(pt,1) DO
            MoveLin pt{i},v,z1,tG\WObj?WObj;
        ENDFOR
        IF Present(Back) THEN
            FOR i FROM Dim(pt,1) TO 1 DO
                MoveLin pt{i},v,z1,tG\WObj?WObj\NoCount;
            ENDFOR
        ENDIF
    ENDPROC
    PROC showSum(num a{*,*})
        VAR num s;
        FOR i FROM 1 TO Dim(a,1) DO FOR j FROM 1 TO Dim(a,2) DO Add s,a{i,j}; ENDFOR ENDFOR
        TPWrite "sum "\Num:=s;
    ENDPROC
    PROC swapEm(INOUT num a,INOUT num b)
        VAR num h; h:=a; a:=b; b:=h;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkWr:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkWr()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG;
        MoveAbsJ jparkWr\NoEOffs,v500,z20,tG;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tG\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tG;
        MoveL pHere,v20,fine,tG;
        WaitTime 1.5;
    ENDPROC
ENDMODULE
