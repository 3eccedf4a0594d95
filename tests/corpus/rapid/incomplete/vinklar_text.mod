MODULE VinklarText
	PROC main()
	    VAR socketdev sockServer;
	    VAR socketdev sockKlient;
	    VAR string stIn;
	    VAR jointtarget jNu;
	    VAR bool ok;
	    CONST jointtarget jHem:=[[0,-10,20,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
	    MoveAbsJ jHem,v1000,fine,tool0;
	    SocketCreate sockServer;
	    SocketBind sockServer,"127.0.0.1",4010;
	    SocketListen sockServer;
	    WHILE TRUE DO
	        SocketAccept sockServer,sockKlient\Time:=WAIT_MAX;
	        SocketReceive sockKlient\Str:=stIn;
	        SocketClose sockKlient;
	        jNu:=Tolka(stIn,jHem);
	        MoveAbsJ jNu,v200,z20,tool0;
	        MoveAbsJ jHem,v200,fine,tool0;
	    ENDWHILE
	ERROR
	    RETRY;
	UNDO
	    SocketClose sockServer;
	ENDPROC

	!  "[10;20;30]" ger de tre första axlarna
	FUNC jointtarget Tolka(string st,jointtarget jVanlig)
	    VAR jointtarget jSvar;
	    VAR num n1;
	    VAR num n2;
	    VAR bool ok;
	    jSvar:=jVanlig;
	    n1:=StrFind(st,1,";");
	    n2:=StrFind(st,n1+1,";");
	    ok:=StrToVal(StrPart(st,2,n1-2),jSvar.robax.rax_1);
	    ok:=StrToVal(StrPart(st,n1+1,n2-n1-1),jSvar.robax.rax_2);
	    ok:=StrToVal(StrPart(st,n2+1,StrLen(st)-n2-1),jSvar.robax.rax_3);
	    RETURN jSvar;
	ENDFUNC
ENDMODULE