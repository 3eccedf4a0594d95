MODULE WeldMain
    ! Rahmen auf Dreh-Kipp-Tisch, rechts
    PERS tasks all_tasks{3}:=[["T_ROB1"],["T_ROB2"],["T_STN1"]];
    VAR syncident sReady;
    VAR syncident sOn;
    VAR syncident sOff;
    VAR syncident sTurned;
    VAR syncident sEnd;
    PERS tooldata tTorch:=[TRUE,[[0,0,330],[1,0,0,0]],[4.1,[-20,0,110],[1,0,0,0],0.05,0.05,0.02]];
    PERS wobjdata wStn1:=[FALSE,FALSE,"STN1",[[0,0,0],[1,0,0,0]],[[0,0,60],[1,0,0,0]]];
    PERS seamdata sm1:=[0.5,0.5,[0,0,0,0,0,0,0,0,0],0,0,0,0,0,[0,0,0,0,0,0,0,0,0],0,0,[0,0,0,0,0,0,0,0,0],0,0,[0,0,0,0,0,0,0,0,0],0];
    PERS welddata wd1:=[12,0,[0,0,0,0,0,0,0,0,0],[0,0,0,0,0,0,0,0,0]];
    PERS num nParts:=0;
    CONST jointtarget jHome:=[[0,-20,20,0,60,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pAbove:=[[0,-260,160],[0,1,0,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pSeam1:=[[-160,-220,12],[0,1,0,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pSeam2:=[[160,-220,12],[0,1,0,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

    PROC main()
        ConfJ\Off;
        ConfL\Off;
        MoveAbsJ jHome\NoEOffs,v500,fine,tTorch;
        WaitSyncTask sReady,all_tasks\TimeOut:=60;
        MoveJ Offs(pAbove,-160,0,0),v500,z20,tTorch\WObj:=wStn1;
        MoveL Offs(pSeam1,0,0,30),v200,fine,tTorch\WObj:=wStn1;
        SyncSeam;
        MoveL Offs(pSeam2,0,0,120),v200,z10,tTorch\WObj:=wStn1;
        WaitSyncTask sTurned,all_tasks;
        MoveAbsJ jHome\NoEOffs,v500,fine,tTorch;
        nParts:=nParts+1;
        WaitSyncTask sEnd,all_tasks;
    UNDO
        SyncMoveUndo;
    ENDPROC

    ! alle drei zusammen, Tisch kippt mit
    PROC SyncSeam()
        SyncMoveOn sOn,all_tasks;
        ArcLStart pSeam1\ID:=10,v100,sm1,wd1\Weave:=wv1,fine,tTorch\WObj:=wStn1;
        FOR i FROM 1 TO 3 DO
            ArcL Offs(pSeam1,80*i,0,0)\ID:=10+i,v100,sm1,wd1,z5,tTorch\WObj:=wStn1;
        ENDFOR
        ArcLEnd pSeam2\ID:=20,v100,sm1,wd1,fine,tTorch\WObj:=wStn1;
        MoveL Offs(pSeam2,0,0,30)\ID:=30,v200,fine,tTorch\WObj:=wStn1;
        SyncMoveOff sOff;
    ENDPROC
    PERS weavedata wv1:=[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0];
ENDMODULE
