MODULE SOUDURE_CADRE
	! ---------------------------------------------------------------
	!  Cellule de soudage MIG - châssis réf. 44-1207
	!  Torche refroidie à l'eau, fil Ø 1.0
	!  Modifié le 02/09/14 : décalage pièce corrigé (J. Lefèvre)
	! ---------------------------------------------------------------
	PERS tooldata tTorche:=[TRUE,[[42.5,0,310],[0.96592583,0,0.25881905,0]],[3.2,[20,0,90],[1,0,0,0],0,0,0]];
	TASK PERS wobjdata wTable:=[FALSE,TRUE,"",[[720,-150,350],[0.99144486,0,0,0.13052619]],[[0,0,0],[1,0,0,0]]];
	
	RECORD parametres
		num tension;
		num fil;
		num vitesse;
		num attente;
	ENDRECORD
	
	CONST parametres cordonFin:=[18.5,4.2,8,0.3];
	CONST parametres cordonLarge:=[23,7.5,6,0.5];
	PERS bool bArcActif:=TRUE;
	VAR num nCordon:=0;
	VAR speeddata vSoudure:=[8,50,5000,1000];
	CONST speeddata vApproche:=[250,90,5000,1000];
	CONST zonedata zCordon:=[FALSE,2,3,3,0.3,3,0.3];
	
	CONST jointtarget jRepos:=[[0,-25,15,0,75,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pEntree:=[[60,40,220],[0,-0.34202,0.939693,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	! cordon 1: ligne droite
	CONST robtarget pC1_10:=[[52.34,48.11,60],[0,-0.34202,0.939693,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC1_20:=[[52.34,48.11,4.12],[0,-0.34202,0.939693,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC1_30:=[[151.9,49.02,4.3],[0,-0.406737,0.913545,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC1_40:=[[248.77,50.4,4.71],[0,-0.461749,0.887011,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC1_50:=[[255,50,75],[0,-0.461749,0.887011,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	! cordon 2: arc de cercle autour du tube
	CONST robtarget pC2_10:=[[270,150,70],[0,-0.5,0.866025,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC2_20:=[[268.4,152.7,6.05],[0,-0.5,0.866025,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC2_25:=[[232.1,190.66,6.1],[0,-0.608761,0.793353,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC2_30:=[[180.2,203.45,6.33],[0,-0.707107,0.707107,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC2_35:=[[128.6,189.9,6.4],[0,-0.793353,0.608761,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC2_40:=[[92.75,150.03,6.18],[0,-0.857167,0.515038,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	CONST robtarget pC2_50:=[[90,150,80],[0,-0.857167,0.515038,0],[-1,0,-2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	
	PROC main()
		Initialiser;
		MoveAbsJ jRepos,v500,fine,tTorche;
		WaitDI diPieceOK,1;
		Cordon1;
		Cordon2;
		! deuxième passe, plus rapide
		IF bDeuxPasses() THEN
			vSoudure.v_tcp:=12;
			Cordon1;
		ENDIF
		MoveJ pEntree,vApproche,z20,tTorche\WObj:=wTable;
		MoveAbsJ jRepos,v500,fine,tTorche;
		PulseDO doFinCycle;
	ENDPROC
	
	FUNC bool bDeuxPasses()
		IF nCordon>0 AND nCordon<=2 RETURN TRUE;
		RETURN FALSE;
	ENDFUNC
	
	PROC Initialiser()
		AccSet 70,70;
		VelSet 100,1000;
		ConfL\Off;
		ConfJ\On;
		SingArea\Off;
		SetDO doGaz,0;
		SetAO aoTension,0;
		SetAO aoFil,0;
		nCordon:=0;
	ENDPROC
	
	PROC ArcMarche(parametres p)
		SetDO doGaz,1;
		WaitTime p.attente;
		IF bArcActif THEN
			SetAO aoTension,p.tension;
			SetAO aoFil,p.fil;
			SetDO doArc,1;
			WaitDI diArcEtabli,1\MaxTime:=1;
		ENDIF
		vSoudure.v_tcp:=p.vitesse;
		nCordon:=nCordon+1;
	ERROR
		IF ERRNO=ERR_WAIT_MAXTIME THEN
			SetDO doArc,0;
			TPWrite "Pas d'arc! Cordon no "+NumToStr(nCordon,0);
			RAISE;
		ENDIF
	ENDPROC
	
	PROC ArcArret(\num temps)
		VAR num t:=0.4;
		IF Present(temps) t:=temps;
		SetDO doArc,0;
		WaitTime t;
		SetDO doGaz,0;
	ENDPROC
	
	PROC Cordon1()
		MoveJ pEntree,vApproche,z20,tTorche\WObj:=wTable;
		MoveL pC1_10,vApproche,z5,tTorche\WObj:=wTable;
		MoveL pC1_20,v50,fine,tTorche\WObj:=wTable;
		ArcMarche cordonFin;
		MoveL pC1_30,vSoudure,zCordon,tTorche\WObj:=wTable;
		MoveL pC1_40,vSoudure,fine,tTorche\WObj:=wTable;
		ArcArret\temps:=0.6;
		MoveL pC1_50,vApproche,z10,tTorche\WObj:=wTable;
	ENDPROC
	
	PROC Cordon2()
		MoveJ pC2_10,vApproche,z5,tTorche\WObj:=wTable;
		MoveL pC2_20,v50,fine,tTorche\WObj:=wTable;
		ArcMarche cordonLarge;
		MoveC pC2_25,pC2_30,vSoudure,z1,tTorche\WObj:=wTable;
		MoveC pC2_35,pC2_40,vSoudure,fine,tTorche\WObj:=wTable;
		ArcArret;
		MoveL pC2_50,vApproche,z10,tTorche\WObj:=wTable;
	ENDPROC
ENDMODULE