MODULE SpotMain
	! IRB 6640 + C gun, order comes as group input: type 1..3, 0 = nothing, 15 = service
	VAR num nOrder;
	VAR num nDone := 0;
	VAR bool bRun := TRUE;
	VAR string stRoutine;
	VAR robtarget pAct;

	PROC main()
		rSafeHome;
		rReset;
		WHILE bRun DO
			nOrder := GInput(giOrder);
			TEST nOrder
			CASE 0:
				bRun := FALSE;
			CASE 1, 2, 3:
				stRoutine := "rType" + NumToStr(nOrder, 0);
				MoveAbsJ jHome, vAir, zAir, tGun;
				%stRoutine%;
				nDone := nDone + 1;
			CASE 15:
				rService;
			DEFAULT:
				TPWrite "order unknown: " \Num:=nOrder;
			ENDTEST
		ENDWHILE
		MoveAbsJ jHome, vAir, fine, tGun;
	ENDPROC

	PROC rReset()
		AccSet 70, 100;
		ConfL\Off;
		ConfJ\Off;
		MoveAbsJ jHome, v500, fine, tGun;
		Reset doGunClose;
		SetGO goSchedule, 0;
		FOR i FROM 1 TO nTypes DO
			nWelds{i} := 0;
		ENDFOR
	ENDPROC

	PROC rSpot(robtarget pWeld, num nSchedule, num nType)
		MoveJ RelTool(pWeld, -60, 0, -80), vAir, zAir, tGun\WObj:=wFixture;
		MoveL RelTool(pWeld, 0, 0, -30), v600, z10, tGun\WObj:=wFixture;
		MoveL pWeld, v300, fine, tGun\WObj:=wFixture;
		SetGO goSchedule, nSchedule;
		Set doGunClose;
		WaitDI diWeldEnd, 1;
		Reset doGunClose;
		WaitTime 0.1;
		MoveL RelTool(pWeld, 0, 0, -30), v600, z10, tGun\WObj:=wFixture;
		MoveL RelTool(pWeld, -60, 0, -80), vAir, zAir, tGun\WObj:=wFixture;
		nWelds{nType} := nWelds{nType} + 1;
	ERROR
		Reset doGunClose;
		TRYNEXT;
	ENDPROC

	PROC rService()
		MoveAbsJ jHome, vAir, z50, tGun;
		MoveAbsJ jService, v500, fine, tGun;
		TPWrite "tip dressing";
		WaitTime 2;
		MoveAbsJ jHome, v500, z50, tGun;
	ENDPROC

	PROC rSafeHome()
		! where are we? low in the fixture: go up along the tool first
		VAR jointtarget jNow;
		jNow := CJointT();
		pAct := CRobT(\Tool:=tGun\WObj:=wFixture);
		IF pAct.trans.x > 0 AND pAct.trans.x < 900 AND pAct.trans.z < 300 THEN
			MoveL RelTool(pAct, 0, 0, -200), v100, z10, tGun\WObj:=wFixture;
		ENDIF
		IF Abs(jNow.robax.rax_1) > 90 THEN
			jNow.robax.rax_2 := -30;
			MoveAbsJ jNow, v100, fine, tGun;
		ENDIF
	ENDPROC
ENDMODULE
