MODULE BoxSorter
	!================================================================
	! Boxes from infeed to one of three lanes, by bar code
	! TODO clean up the old lane 4 code (see bottom)
	!================================================================
	PERS tooldata tClamp:=[TRUE,[[0,0,320],[1,0,0,0]],[55,[0,0,170],[1,0,0,0],0,0,0]];
	TASK PERS wobjdata wConv1:=[FALSE,TRUE,"",[[1200,-800,250],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
	TASK PERS wobjdata wConv2:=[FALSE,TRUE,"",[[1100,500,250],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
	PERS loaddata ldBox{3}:=[[8,[0,0,120],[1,0,0,0],0.1,0.1,0.1],[15,[0,0,150],[1,0,0,0],0.2,0.2,0.2],[22,[0,0,170],[1,0,0,0],0.4,0.4,0.3]];

	CONST robtarget pInfeed:=[[120.5,180.25,140],[0,-0.3420201,0.9396926,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
	CONST robtarget pLane{3}:=[[[80,40,150],[0,-0.7372773,0.6755902,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
		[[330,60,150],[0,-0.7372773,0.6755902,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],
		[[560,80,150],[0,-0.7372773,0.6755902,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]]];
	CONST robtarget pMid:=[[1480,0.5,1100],[0,-0.5372996,0.8433914,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
	CONST robtarget pReject:=[[900,-1250,700],[0,-0.0871557,0.9961947,0],[-1,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
	CONST jointtarget jPark:=[[0,-25,30,0,70,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];

	VAR num nLane:=1;
	VAR num nWeight:=1;
	VAR num nBox:=0;
	VAR num nErrors:=0;
	VAR bool bTimeOut:=FALSE;
	VAR errnum ERR_CODE:=-1;
	VAR string stCode;
	VAR iodev ioLog;
	PERS num nLaneCount{3}:=[0,0,0];
	CONST num nBoxes:=5;
	CONST string stTest{5}:=["A1-08","B2-15","C3-22","??","A1-15"];

	PROC main()
		BookErrNo ERR_CODE;
		initCell;
		MoveAbsJ jPark,v1000,fine,tClamp;
		WHILE nBox<nBoxes DO
			Incr nBox;
			nextBox;
		ENDWHILE
		MoveAbsJ jPark\NoEOffs,v1000,fine,tClamp;
		closeLog;
	ERROR
		IF ERRNO=ERR_CODE THEN
			nErrors:=nErrors+1;
			TRYNEXT;
		ENDIF
		RAISE;
	ENDPROC

	PROC initCell()
		AccSet 65,80;
		VelSet 100,2500;
		ConfL\Off;
		ConfJ\Off;
		MotionSup\On\TuneValue:=150;
		GripLoad load0;
		SetDO doClamp,0;
		nErrors:=0;
		FOR i FROM 1 TO 3 DO
			nLaneCount{i}:=0;
		ENDFOR
		Open "HOME:"\File:="sorter.log",ioLog\Append;
		Write ioLog,CDate()+" "+CTime()+" start";
	ERROR
		TRYNEXT;
	ENDPROC

	PROC closeLog()
		Write ioLog,"boxes: "\Num:=nBox;
		Close ioLog;
	ENDPROC

	PROC nextBox()
		VAR bool bValid;
		WaitDI diBoxThere,1\MaxTime:=30\TimeFlag:=bTimeOut;
		stCode:=stTest{nBox};
		bValid:=readCode(stCode,nLane,nWeight);
		getBox;
		IF bValid THEN
			putBox nLane;
		ELSE
			rejectBox;
		ENDIF
	ENDPROC

	FUNC bool readCode(string st,INOUT num lane,INOUT num kind)
		VAR string stLane;
		VAR bool b:=TRUE;
		IF StrLen(st)<5 RETURN FALSE;
		stLane:=StrPart(st,2,1);
		TEST stLane
		CASE "1":
			lane:=1;
		CASE "2":
			lane:=2;
		CASE "3":
			lane:=3;
		DEFAULT:
			b:=FALSE;
		ENDTEST
		kind:=1;
		IF StrPart(st,4,2)="15" kind:=2;
		IF StrPart(st,4,2)="22" kind:=3;
		RETURN b AND lane>=1 AND lane<=3;
	ENDFUNC

	PROC getBox()
		MoveJ Offs(pInfeed,0,0,400),v2000,z100,tClamp\WObj:=wConv1;
		MoveL Offs(pInfeed,0,0,60),v1000,z20,tClamp\WObj:=wConv1;
		MoveL pInfeed,v300,fine,tClamp\WObj:=wConv1;
		SetDO doClamp,1;
		WaitDI diClamped,1;
		GripLoad ldBox{nWeight};
		MoveL Offs(pInfeed,0,0,400),v800,z50,tClamp\WObj:=wConv1;
	BACKWARD
		MoveL Offs(pInfeed,0,0,400),v200,fine,tClamp\WObj:=wConv1;
	ERROR
		SetDO doClamp,0;
		RETRY;
	ENDPROC

	PROC putBox(num n)
		MoveJ pMid,v2000,z150,tClamp;
		MoveJ Offs(pLane{n},0,0,350),v1500,z80,tClamp\WObj:=wConv2;
		MoveL Offs(pLane{n},0,0,40),v800,z20,tClamp\WObj:=wConv2;
		MoveL pLane{n},v200,fine,tClamp\WObj:=wConv2;
		SetDO doClamp,0;
		WaitTime 0.4;
		GripLoad load0;
		MoveL Offs(pLane{n},0,0,350),v1500,z50,tClamp\WObj:=wConv2;
		MoveJ pMid,v2000,z150,tClamp;
		Add nLaneCount{n},1;
	UNDO
		SetDO doClamp,0;
	ENDPROC

	PROC rejectBox()
		VelSet 60,2500;
		MoveJ pReject,v1000,z50,tClamp;
		MoveL Offs(pReject,0,0,-250),v300,fine,tClamp;
		SetDO doClamp,0;
		WaitTime 0.4;
		GripLoad load0;
		MoveL pReject,v1000,z50,tClamp;
		VelSet 100,2500;
		TPWrite "rejected: "+stCode;
	ENDPROC

	!PROC lane4()
	!	MoveJ pLane4,v1000,z50,tClamp;
	!ENDPROC
ENDMODULE