MODULE LaserTrim
	! Trims holes and slots; all geometry is calculated from the drawing.
	! Focus distance is in the tool, do NOT change tLaser without new focus test!
	PERS tooldata tLaser:=[TRUE,[[0,0,180],[1,0,0,0]],[2.8,[0,0,50],[1,0,0,0],0,0,0]];
	TASK PERS wobjdata wPart:=[FALSE,TRUE,"",[[900,100,500],[0.9990482216,0,0,0.0436193874]],[[0,0,0],[1,0,0,0]]];
	CONST robtarget pZero:=[[0,0,0],[0,-0.5,0.8660254,0],[0,0,-1,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
	CONST jointtarget jWait:=[[8,-15,15,0,80,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];
	CONST speeddata vCut:=[60,45,5000,1000];
	CONST speeddata vLeadIn:=[30,45,5000,1000];
	CONST zonedata zCut:=[FALSE,0.5,0.75,0.75,0.075,0.75,0.075];
	CONST num nHole{3,3}:=[[-60,-40,12.5],[-60,55,9],[75,-38,16.2]];
	CONST num nSlot{2,4}:=[[20,60,60,8],[-20,0,45,6]];
	VAR pose peShift;
	VAR pos psNow;
	VAR orient orTool;
	VAR num nHoles:=0;
	VAR num nLength;

	PROC main()
		initAll;
		MoveAbsJ jWait,v500,fine,tLaser;
		FOR n FROM 1 TO 3 DO
			Hole nHole{n,1},nHole{n,2},nHole{n,3}\nSteps:=4*n;
		ENDFOR
		FOR n FROM 2 TO 1 STEP -1 DO
			Slot n;
		ENDFOR
		TrimCorner;
		MoveAbsJ jWait,v500,fine,tLaser;
		TPWrite "holes "\Num:=nHoles;
	ENDPROC

	PROC initAll()
		ConfL\Off;
		ConfJ\Off;
		SingArea\Off;
		AccSet 60,60;
		nHoles:=0;
		peShift:=[[0,0,0],[1,0,0,0]];
		laserOff;
	ENDPROC

	LOCAL PROC laserOn()
		SetAO aoPower,72.5;
		SetDO doShutter,1;
		WaitDI diShutterOpen,1;
	ENDPROC

	LOCAL PROC laserOff()
		SetDO doShutter,0;
		SetAO aoPower,0;
	ENDPROC

	PROC Hole(num cx,num cy,num r,\num nSteps)
		! circle as a chain of arcs, starting at angle 0
		VAR num n:=4;
		VAR num a;
		VAR num d;
		VAR robtarget pVia;
		VAR robtarget pTo;
		IF Present(nSteps) THEN
			n:=nSteps;
		ENDIF
		d:=360/n;
		MoveJ Offs(pZero,cx,cy,40),v500,z10,tLaser\WObj:=wPart;
		MoveL Offs(pZero,cx+r/2,cy,0),v200,fine,tLaser\WObj:=wPart;
		laserOn;
		MoveL Offs(pZero,cx+r,cy,0),vLeadIn,zCut,tLaser\WObj:=wPart;
		FOR i FROM 1 TO n DO
			a:=(i-1)*d;
			pVia:=Offs(pZero,cx+r*Cos(a+d/2),cy+r*Sin(a+d/2),0);
			pTo:=Offs(pZero,cx+r*Cos(a+d),cy+r*Sin(a+d),0);
			IF i<n THEN
				MoveC pVia,pTo,vCut,z0,tLaser\WObj:=wPart;
			ELSE
				MoveC pVia,pTo,vCut,fine,tLaser\WObj:=wPart;
			ENDIF
		ENDFOR
		laserOff;
		MoveL Offs(pZero,cx,cy,40),v200,z10,tLaser\WObj:=wPart;
		Incr nHoles;
	ENDPROC

	PROC Slot(num k)
		VAR num l;
		VAR num w;
		VAR robtarget pA;
		VAR robtarget pB;
		l:=nSlot{k,3};
		w:=nSlot{k,4};
		pA:=Offs(pZero,nSlot{k,1},nSlot{k,2},0);
		pB:=Offs(pA,l,0,0);
		nLength:=Distance(pA.trans,pB.trans);
		IF nLength<1 THEN
			TPWrite "slot too short";
			RETURN;
		ENDIF
		MoveJ Offs(pA,0,0,30),v500,z10,tLaser\WObj:=wPart;
		MoveL Offs(pA,0,w/2,0),v100,fine,tLaser\WObj:=wPart;
		laserOn;
		MoveL Offs(pB,0,w/2,0),vCut,zCut,tLaser\WObj:=wPart;
		MoveC Offs(pB,w/2,0,0),Offs(pB,0,-w/2,0),vCut,zCut,tLaser\WObj:=wPart;
		MoveL Offs(pA,0,-w/2,0),vCut,zCut,tLaser\WObj:=wPart;
		MoveC Offs(pA,-w/2,0,0),Offs(pA,0,w/2,0),vCut,fine,tLaser\WObj:=wPart;
		laserOff;
		MoveL Offs(pA,0,0,30),v200,z10,tLaser\WObj:=wPart;
	ENDPROC

	PROC TrimCorner()
		VAR robtarget p;
		orTool:=pZero.rot*OrientZYX(0,0,8);
		psNow:=[90,70,0];
		p:=pZero;
		p.trans:=psNow;
		p.rot:=orTool;
		MoveJ Offs(p,0,0,50),v500,z10,tLaser\WObj:=wPart;
		MoveL p,v100,fine,tLaser\WObj:=wPart;
		laserOn;
		p.trans.x:=p.trans.x+15;
		p.trans.y:=p.trans.y-15;
		MoveL p,vCut,fine,tLaser\WObj:=wPart;
		laserOff;
		MoveL RelTool(p,0,0,-60),v500,z20,tLaser\WObj:=wPart;
		! the same once more, shifted by the frame
		peShift.trans:=[-20,10,0];
		PDispSet peShift;
		MoveL p,v200,z1,tLaser\WObj:=wPart;
		MoveL RelTool(p,0,0,-60),v500,z20,tLaser\WObj:=wPart;
		PDispOff;
	ENDPROC
ENDMODULE