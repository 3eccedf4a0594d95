MODULE TableMain
    ! Tisch STN1 kippt um x
    PERS tasks all_tasks{3}:=[["T_ROB1"],["T_ROB2"],["T_STN1"]];
    VAR syncident sReady;
    VAR syncident sOn;
    VAR syncident sOff;
    VAR syncident sTurned;
    VAR syncident sEnd;
    VAR speeddata vTilt:=[100,20,500,20];
    PERS jointtarget jLevel:=[[0,0,0,0,0,0],[0,9E+09,9E+09,9E+09,9E+09,9E+09]];
    PERS jointtarget jWeld:=[[9E9,9E9,9E9,9E9,9E9,9E9],[-6,9E+09,9E+09,9E+09,9E+09,9E+09]];
    LOCAL VAR jointtarget jNow;

    PROC main()
        ActUnit STN1;
        MoveExtJ jLevel,vTilt,fine;
        MoveExtJ jWeld,vTilt,fine;
        WaitSyncTask sReady,all_tasks\TimeOut:=60;
        tilt;
        WaitSyncTask sTurned,all_tasks;
        MoveExtJ jLevel,vTilt,fine;
        WaitSyncTask sEnd,all_tasks;
    UNDO
        SyncMoveUndo;
    ENDPROC

    PROC tilt()
        SyncMoveOn sOn,all_tasks;
        jNow:=jWeld;
        MoveExtJ jNow\ID:=10,vTilt,fine;
        FOR i FROM 1 TO 3 DO
            jNow.extax.eax_a:=-6+4*i;
            MoveExtJ jNow\ID:=10+i,vTilt,z10;
        ENDFOR
        jNow.extax.eax_a:=8;
        MoveExtJ jNow\ID:=20,vTilt,fine;
        MoveExtJ jNow\ID:=30,vTilt,fine;
        SyncMoveOff sOff;
    ENDPROC
ENDMODULE
