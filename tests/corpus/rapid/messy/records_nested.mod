MODULE RecNest(NOSTEPIN)
    ALIAS num level;
    ALIAS robtarget place;
    RECORD limits
        num nMin;
        num nMax;
    ENDRECORD
    RECORD partdata
        string stName;
        level nLevel;
        limits limZ;
        pose posShift;
        bool bUsed;
        loaddata ld;
    ENDRECORD
    LOCAL RECORD stationtype
        partdata prt;
        place pIn;
        num nParts;
    ENDRECORD
    PERS partdata part{2}:=[["cover",1,[10,80],[[0,0,0],[1,0,0,0]],TRUE,[1,[0,0,1],[1,0,0,0],0,0,0]],
      ["base",2,[5,40],[[10,5,0],[0.9998477,0,0,0.0174524]],TRUE,[2,[0,0,10],[1,0,0,0],0,0,0]]];
    LOCAL VAR stationtype station{2,2};
    PERS tooldata tG:=[TRUE,[[0,0,140],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];
    CONST robtarget pBase:=[[400,-100,250],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    VAR num nIndex{4}:=[4,3,2,1];
    VAR byte b1:=0x1F;
    PROC main()
        VAR stationtype st;
        VAR partdata p;
        ConfL\Off; ConfJ\Off;
        setup;
        FOR i FROM 1 TO Dim(station,1) DO
            FOR j FROM Dim(station,2) TO 1 STEP -1 DO
                st:=station{i,j};
                IF st.prt.bUsed visit st,\Height:=60+st.prt.nLevel*10\Slow;
            ENDFOR
        ENDFOR
        FOR k FROM 10 TO 30 STEP 2*nIndex{1}+2 DO
            visit station{1,1}\Height:=k;
        ENDFOR
        p:=byName("base");
        IF p.stName="base" MoveL Offs(pBase,p.posShift.trans.x,p.posShift.trans.y,p.limZ.nMax),v200,fine,tG;
        b1:=BitAnd(b1,BitNeg(4));
        IF BitCheck(b1,1) TPWrite "bit "+ByteToStr(b1\Hex)+" "+ValToStr(part{1}.limZ);
        parkRec;
    ENDPROC
    LOCAL PROC setup()
        VAR num n:=0;
        FOR i FROM 1 TO 2 DO
            FOR j FROM 1 TO 2 DO
                n:=n+1;
                station{i,j}.prt:=part{j};
                station{i,j}.prt.limZ.nMax:=part{j}.limZ.nMax+n;
                station{i,j}.pIn:=Offs(pBase,40*i,60*j,0);
                station{i,j}.pIn.rot:=pBase.rot*OrientZYX(5*n,0,0);
                station{i,j}.nParts:=n;
            ENDFOR
        ENDFOR
        station{2,2}.prt.bUsed:=FALSE;
    ENDPROC
    LOCAL FUNC partdata byName(string st)
        FOR i FROM 1 TO Dim(part,1) DO
            IF part{i}.stName=st RETURN part{i};
        ENDFOR
        RETURN part{1};
    ENDFUNC
    LOCAL PROC visit(stationtype s\num Height\switch Slow|switch Fast)
        VAR speeddata v:=v500;
        VAR num h:=100;
        IF Present(Height) h:=Height;
        IF Present(Slow) v.v_tcp:=100;
        MoveL Offs(s.pIn,0,0,h),v,z10,tG;
        MoveL s.pIn,v\V:=50,fine,tG;
        GripLoad s.prt.ld;
        MoveL Offs(s.pIn,0,0,h),v,z10,tG;
    ENDPROC

    !----------------------------------------------------------
    ! parking, for the night and for the maintenance people
    !----------------------------------------------------------
    LOCAL CONST jointtarget jparkRec:=[[0,-10,20,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PROC parkRec()
        VAR robtarget pHere;
        VAR jointtarget jHere;
        MoveJ [[420,0,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v200,z10,tG;
        MoveAbsJ jparkRec\NoEOffs,v500,z20,tG;
        jHere:=CJointT();
        IF Abs(jHere.robax.rax_1)>1 THEN
            TPWrite "axis 1 is at "+NumToStr(jHere.robax.rax_1,1);
        ENDIF
        pHere:=CRobT(\Tool:=tG\WObj:=wobj0);
        MoveL Offs(pHere,0,0,40),v20,z5,tG;
        MoveL pHere,v20,fine,tG;
        WaitTime 1.5;
    ENDPROC

    PROC serviceMenu()
        VAR num nChoice;
        TPErase;
        TPReadFK nChoice,"Service","Oil","Belt","Zero",stEmpty,"Back";
        IF nChoice=5 RETURN;
        IF nChoice=3 THEN
            MoveAbsJ [[0,0,0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],v100,fine,tool0;
            Stop;
        ELSE
            UIMsgBox "See the manual, chapter "+ValToStr(nChoice);
        ENDIF
    ENDPROC
ENDMODULE