MODULE VisionPick
    !##########################################################
    ! Random bin (1 layer), camera over the light table
    ! 3.2.2018  first version            tk
    ! 9.4.2018  retry when nothing found tk
    ! 11.1.21   new box, 2 x 4 places    mh
    !##########################################################
    RECORD part
        pos place;
        num angle;
        num kind;
        bool valid;
    ENDRECORD
    RECORD slot
        num x;
        num y;
        bool used;
    ENDRECORD

    PERS tooldata tVac:=[TRUE,[[0,0,105.5],[1,0,0,0]],[0.65,[0,0,40],[1,0,0,0],0,0,0]];
    TASK PERS wobjdata wCam:=[FALSE,TRUE,"",[[350,-260,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    TASK PERS wobjdata wBox:=[FALSE,TRUE,"",[[300,240,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
    TASK PERS loaddata ldPart:=[0.12,[0,0,15],[1,0,0,0],0,0,0];

    CONST string stIp:="192.168.125.40";
    CONST num nPort:=3456;
    VAR socketdev sock;
    VAR string stAnswer;
    VAR bool bOk;
    VAR part ptFound{4};
    VAR num nFound:=0;
    CONST part ptTest{4}:=[[[62.4,75.8,0],12,1,TRUE],
                           [[118.25,40.6,0],-35,1,TRUE],
                           [[155,132.7,0],60,2,TRUE],
                           [[40.9,150.15,0],5,1,FALSE]];
    PERS slot slBox{8}:=[[0,0,FALSE],[55,0,FALSE],[110,0,FALSE],[165,0,FALSE],[0,60,FALSE],[55,60,FALSE],[110,60,FALSE],[165,60,FALSE]];

    CONST robtarget pCamBase:=[[0,0,8.5],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pCamClear:=[[100,100,180],[0,-0.258819,0.9659258,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pBox1:=[[30.2,25.75,22.1],[0,-0.258819,0.9659258,0],[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST robtarget pOver:=[[420,30,420],[0,-0.258819,0.9659258,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
    CONST jointtarget jHome:=[[0,-20,30,0,80,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

    CONST speeddata vPick:=[150,200,5000,1000];
    PERS num nAboveMm:=60;
    VAR robtarget pHere;
    VAR jointtarget jHere;

    PROC main()
        VAR num nPlace:=1;
        init;
        ! after power on the robot must be jogged home first
        MoveAbsJ jHome,v100,fine,tVac;
        goHome;
        getParts;
        FOR i FROM 1 TO nFound DO
            IF ptFound{i}.valid THEN
                pick ptFound{i};
                place nPlace;
                slBox{nPlace}.used:=TRUE;
                nPlace:=nPlace+1;
            ELSE
                TPWrite "skipped part "+ValToStr(i);
            ENDIF
        ENDFOR
        goHome;
        TPWrite "free places: "\Num:=nFree();
    ENDPROC

    PROC init()
        ConfL\Off;
        ConfJ\Off;
        AccSet 100,100;
        FOR i FROM 1 TO Dim(slBox,1) DO
            slBox{i}.used:=FALSE;
        ENDFOR
        SetDO doVac,0;
        SetDO doLight,0;
    ENDPROC

    PROC getParts()
        SetDO doLight,1;
        SocketClose sock;
        SocketCreate sock;
        SocketConnect sock,stIp,nPort\Time:=5;
        SocketSend sock\Str:="TRIG\0D";
        SocketReceive sock\Str:=stAnswer\Time:=10;
        SocketClose sock;
        SetDO doLight,0;
        ! answer is "n;x,y,a,k;..."
        bOk:=StrToVal(StrPart(stAnswer,1,1),nFound);
        IF NOT bOk nFound:=0;
        IF nFound=0 THEN
            ! no camera: test data
            nFound:=Dim(ptTest,1);
            FOR i FROM 1 TO nFound DO
                ptFound{i}:=ptTest{i};
            ENDFOR
        ENDIF
    ERROR
        IF ERRNO=ERR_SOCK_TIMEOUT THEN
            RETRY;
        ELSEIF ERRNO=ERR_SOCK_CLOSED THEN
            TPWrite "camera not connected";
            TRYNEXT;
        ENDIF
    ENDPROC

    FUNC robtarget partTarget(part pt,\num height)
        VAR robtarget pResult;
        VAR num h:=0;
        IF Present(height) h:=height;
        pResult:=pCamBase;
        pResult.trans:=pCamBase.trans+pt.place;
        pResult.trans.z:=pResult.trans.z+h;
        IF pt.kind=2 pResult.trans.z:=pResult.trans.z+4.5;
        RETURN RelTool(pResult,0,0,0\Rz:=-pt.angle);
    ENDFUNC

    FUNC num nFree()
        VAR num n:=0;
        FOR i FROM 1 TO Dim(slBox,1) DO
            IF NOT slBox{i}.used Incr n;
        ENDFOR
        RETURN n;
    ENDFUNC

    PROC pick(part pt)
        MoveJ pCamClear,v1000,z50,tVac\WObj:=wCam;
        MoveL partTarget(pt\height:=nAboveMm),v1000,z10,tVac\WObj:=wCam;
        MoveL partTarget(pt),vPick,fine,tVac\WObj:=wCam;
        SetDO doVac,1;
        WaitTime 0.1;
        GripLoad ldPart;
        MoveL partTarget(pt\height:=nAboveMm),v500,z10,tVac\WObj:=wCam;
        MoveJ pOver,v1500,z50,tVac;
    ENDPROC

    PROC place(num n)
        VAR robtarget p;
        p:=Offs(pBox1,slBox{n}.x,slBox{n}.y,0);
        MoveJ Offs(p,0,0,90),v1500,z20,tVac\WObj:=wBox;
        MoveL p,vPick,fine,tVac\WObj:=wBox;
        SetDO doVac,0;
        PulseDO\PLength:=0.1,doBlow;
        WaitTime 0.05;
        GripLoad load0;
        MoveL Offs(p,0,0,90),v800,z10,tVac\WObj:=wBox;
        MoveJ pOver,v1500,z50,tVac;
    ENDPROC

    PROC goHome()
        ! straight up first, then home
        pHere:=CRobT(\Tool:=tVac\WObj:=wobj0);
        IF pHere.trans.z<350 THEN
            pHere.trans.z:=350;
            MoveL pHere,v200,fine,tVac;
        ENDIF
        jHere:=CJointT();
        jHere.robax.rax_5:=80;
        MoveAbsJ jHere,v200,z10,tVac;
        MoveAbsJ jHome,v500,fine,tVac;
    ENDPROC
ENDMODULE
