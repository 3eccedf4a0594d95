MODULE ToolCal
    CONST num nNumberPoints:=4;
    CONST jointtarget jP{4}:=[[[0,10,10,0,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[5,12,10,10,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[-5,12,12,-10,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[0,15,5,0,30,45],[9E9,9E9,9E9,9E9,9E9,9E9]]];
    VAR robtarget pts{4};
    VAR num A{3,3}; VAR num b{3}; VAR num x{3};
    VAR num nMaxError; VAR num nMeanError;
    VAR pose ps; VAR pos posC;
    TASK PERS tooldata toolToDet:=[TRUE,[[20.17,0.74,363.3],[0.946578,0.191449,0.0562058,0.253336]],[1,[0,0,1],[1,0,0,0],0,0,0]];
    PROC main()
        FOR i FROM 1 TO nNumberPoints DO
            pts{i}:=CalcRobT(jP{i},tool0\WObj:=wobj0);
            MoveAbsJ jP{i},v200,fine,tool0;
            pts{i}:=CRobT(\Tool:=tool0\WObj:=wobj0);
        ENDFOR
        calcError;
        MToolTCPCalib jP{1},jP{2},jP{3},jP{4},toolToDet,nMaxError,nMeanError;
        ps:=DefFrame(pts{1},pts{2},pts{3});
        ps:=DefAccFrame(pts,pts,4,nMaxError,nMeanError);
        MoveJ Offs(pts{1},0,0,20),v100,fine,tool0;
        posC:=pts{1}.trans;
        IF Distance(posC,pts{2}.trans)>10 AND EulerZYX(\X,pts{1}.rot)>-200 THEN
          MoveL Offs(pts{1},0,0,10+DotProd(posC,[0,0,0])),v100,fine,toolToDet;
        ENDIF
    ERROR
        ExitCycle;
    ENDPROC
    PROC calcError()
        VAR num sum:=0; VAR num dist;
        nMeanError:=0;
        FOR i FROM 1 TO nNumberPoints DO
            dist:=Sqrt(Pow(pts{i}.trans.x-pts{1}.trans.x,2)+Pow(pts{i}.trans.y,2));
            IF dist>nMaxError nMaxError:=dist;
            sum:=sum+dist;
        ENDFOR
        nMeanError:=sum/nNumberPoints;
    ENDPROC
ENDMODULE
