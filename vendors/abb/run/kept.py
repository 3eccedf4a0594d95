"""Instructions that stay in the program as they stand: they are stepped over, with a note.

Names: "RAPID Reference Manual" and the application manuals of RobotWare's options (force control,
externally guided motion, conveyor tracking, MultiMove, spot and arc welding, painting, …).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ....core.source.text.lexer import words
from ..syntax.tree import Argument


@dataclass(frozen=True, slots=True)
class Kept:
    """An instruction that stays in the program as it stands and is stepped over.

    Args:
        why: what it does, for the note; empty if nothing needs to be said.
        stops: the robot comes to rest before it, or waits in it.
        writes: data that it names get values that only the running controller has.
        sent: a computer sends the robot's motion while it runs.
    """

    why: str
    stops: bool = False
    writes: bool = False
    sent: bool = False


_IO = Kept("I/O does not move the robot")
_MESSAGE = Kept("messages and files do not move the robot")
_INPUT = Kept("what it brings is not known", stops=True, writes=True)
_CAMERA = Kept("cameras do not move the robot")
_CLOCK = Kept("clocks do not move the robot")
_INTERRUPT = Kept("interrupts are not emulated: their trap routines do not run")
_WAITING = Kept("taken as satisfied at once: waiting takes no time here", stops=True)
_HALT = Kept("taken as continued at once: waiting takes no time here", stops=True)
_SUPERVISION = Kept("supervision does not change the programmed motion")
_FILL = Kept("what it computes is not known", writes=True)

_SERVO = Kept("how stiffly the servos follow is not emulated")
_UNIT = Kept("switching a mechanical unit on or off does not move it", stops=True)
_RESUMED = Kept("the stop is taken as resumed at once", stops=True)
_TASK = Kept("other tasks are taken to be there at once", stops=True)
_TOGETHER = Kept(
    "the other robots' moves are not at hand: this one drives alone, at its own speed", stops=True
)
_GUIDED = Kept("guided motion is prepared by it")
_STREAM = Kept(
    "a sensor moves the robot by what it sends (EGM): not driven, the robot is taken to stand "
    "where it is afterwards",
    stops=True,
    sent=True,
)
_SENSOR = Kept("what the sensor says of its motion is not known: it is taken to stand still")
_BELT = Kept("the conveyor is taken to stand, with the part where its work object is", stops=True)
_CORRECTION = Kept("corrections of the path by a sensor are not known: none are taken")
_RECOVERY = Kept("the path before it is taken to be driven to its end", stops=True)
_BACKWARD = Kept(
    "it drives along the recorded path, which is not emulated: the robot is taken to stay",
    stops=True,
)
_INDEPENDENT = Kept("independent motion of an axis beside the program is not emulated")
_FORCE = Kept("force control is not emulated: the robot drives as programmed")
_LOAD_TEST = Kept(
    "the robot moves to and fro to measure a load: not driven, the load stays as it is", stops=True
)
_GUN = Kept("a servo gun's own motion is not emulated", stops=True)
_DATA = Kept("what it does to the trigger data is not carried out")
_ZONES = Kept("supervision of zones does not change the programmed motion")
_GRIPPER = Kept("a gripper's own motion is not emulated")
_PROCESS = Kept("process equipment does not change the programmed motion")
_SAFETY = Kept("safety functions do not change the programmed motion")
_BRAKES = Kept("brakes are tested at rest", stops=True)
_MODULES = Kept("modules of the program are looked for beside it when their names are missed")


def _kept(kept: Kept, names: str) -> dict[str, Kept]:
    return dict.fromkeys(words(names), kept)


KEPT: dict[str, Kept] = {
    **_kept(_IO, "set reset setdo setao setgo pulsedo invertdo ioenable iodisable"),
    **_kept(_IO, "aliasio aliasioreset iobusstart settmsignal setupcyclicbool removecyclicbool"),
    **_kept(_IO, "removeallcyclicbool cleariobuff clearioboff"),
    **_kept(_MESSAGE, "tpwrite tperase tpshow errwrite errlog uishow uimsgwrite open close write"),
    **_kept(_MESSAGE, "uimsgwriteabort writebin writestrbin writeanybin writerawbytes rewind"),
    **_kept(_MESSAGE, "writeblock writecfgdata writevar writevararr savecfgdata scwrite sendevice"),
    **_kept(_MESSAGE, "removefile renamefile copyfile makedir removedir opendir closedir"),
    **_kept(_MESSAGE, "spywrite spystart spystop consolewrite pntproduserlog"),
    **_kept(_MESSAGE, "socketcreate socketbind socketlisten socketclose socketsend socketsendto"),
    **_kept(_MESSAGE, "rmqsendmessage rmqsendwait rmqemptyqueue rmqfindslot siconnect siclose"),
    **_kept(_MESSAGE, "sisetcyclic packdnheader tpwritednum uiclientshow textabinstall"),
    **_kept(_MESSAGE, "texttabinstall checkprogref testsigndefine testsignreset deleteobject"),
    **_kept(_MESSAGE, "hotedit iomessage tryint acteventbuffer deacteventbuffer"),
    **_kept(_MODULES, "load unload save erasemodule startload cancelload waitload"),
    **_kept(_INPUT, "tpreadfk tpreadnum tpreaddnum uimsgbox readanybin readrawbytes readblock"),
    **_kept(_INPUT, "socketaccept socketconnect socketreceive socketreceivefrom rmqreadwait"),
    **_kept(_INPUT, "camgetparameter camgetresult sigetcyclic"),
    **_kept(_CAMERA, "camflush camloadjob camreqimage camsetexposure camsetparameter aliascamera"),
    **_kept(_CAMERA, "camsetprogrammode camsetrunmode camstartloadjob camwaitloadjob"),
    **_kept(_CLOCK, "clkstart clkstop clkreset pathlengthreset pathlengthstart pathlengthstop"),
    **_kept(_CLOCK, "resetaxisdistance resetaxismovetime resettorquemargin resetppmoved"),
    **_kept(_INTERRUPT, "connect idelete idisable ienable isleep iwatch itimer ierror ipers"),
    **_kept(_INTERRUPT, "irmqmessage isignaldi isignaldo isignalai isignalao isignalgi isignalgo"),
    **_kept(_INTERRUPT, "ivarvalue icap ipathpos"),
    **_kept(_WAITING, "waituntil waitdi waitdo waitai waitao waitgi waitgo waittestandset"),
    **_kept(Kept("", stops=True), "waitrob"),
    **_kept(_HALT, "stop break"),
    **_kept(_SUPERVISION, "motionsup cornerpathwarning seterrno skipwarn setsysdata setalldataval"),
    **_kept(_SUPERVISION, "tunereset softdeact eoffsoff clearpath resetretrycount procerrrecovery"),
    **_kept(_SUPERVISION, "speedlimaxis speedlimcheckpoint softelbow ditheract ditherdeact"),
    **_kept(_FILL, "gettrapdata setdatasearch packrawbytes unpackrawbytes readvar"),
    **_kept(_FILL, "clearrawbytes copyrawbytes readcfgdata readerrdata readvararr getjointdata"),
    **_kept(_FILL, "rmqgetmessage rmqgetmsgdata rmqgetmsgheader getgroupsignalinfo iobusstate"),
    **_kept(_FILL, "gettorquemargin matrixsolve matrixsolveqr matrixsvd fitcircle swgetcalibdata"),
    **_kept(_SERVO, "softact tuneservo pathresol mechunitload motionprocessmodeset fricidinit"),
    **_kept(_SERVO, "fricidevaluate fricidsetfriclevels hollowwristreset"),
    **_kept(_UNIT, "actunit deactunit ioctrlaxis_refsync ioctrlaxis_refsyncon"),
    **_kept(_UNIT, "ioctrlaxis_refsyncoff"),
    **_kept(_RESUMED, "stopmove startmove stopmovereset startmoveretry"),
    **_kept(_TASK, "waitsynctask"),
    **_kept(_TOGETHER, "syncmoveon syncmoveoff syncmoveundo syncmovesuspend syncmoveresume"),
    **_kept(_GUIDED, "egmsetupuc egmsetupai egmsetupgi egmsetupao egmsetupltapp egmreset egmgetid"),
    **_kept(_GUIDED, "egmstop egmactjoint egmactpose egmactmove"),
    **_kept(_STREAM, "egmrunjoint egmrunpose egmstreamstart egmstreamstop"),
    **_kept(_SENSOR, "supsyncsensoron supsyncsensoroff synctosensor waitsensor dropsensor"),
    **_kept(_SENSOR, "prxactivandstorerecord prxactivrecord prxdbgstorerecord prxdeactrecord"),
    **_kept(_SENSOR, "prxresetpos prxresetrecords prxsetposoffset prxsetrecordsampletime"),
    **_kept(_SENSOR, "prxsetsyncalarm prxstartrecord prxstoprecord prxstorerecord"),
    **_kept(_SENSOR, "prxusefilerecord setupsuperv initsuperv removesuperv"),
    **_kept(_BELT, "waitwobj dropwobj cnvsync cnvgeninstr indcnvinit indcnvenable indcnvdisable"),
    **_kept(_BELT, "indcnvreset indcnvaddobject syncwwobj useaccprofile recordprofile"),
    **_kept(_BELT, "waitandrecprof storeprofile loadprofile activateprofile deactprofile"),
    **_kept(_BELT, "usereachabletargets resetmaxusagetime"),
    **_kept(_CORRECTION, "corrcon corrwrite corrclear corrdiscon"),
    **_kept(_RECOVERY, "storepath restopath pathrecstart pathrecstop mpsavepath mploadpath"),
    **_kept(_RECOVERY, "mpreadinpath mpoffseaxonpath recoveryposset recoveryposreset"),
    **_kept(_BACKWARD, "pathrecmovebwd pathrecmovefwd stepbwdpath"),
    **_kept(_INDEPENDENT, "indamove indcmove inddmove indrmove indreset"),
    **_kept(_FORCE, "fccalib fcact fcdeact fcrefcircle fcrefforce fcrefline fcrefmoveframe"),
    **_kept(_FORCE, "fcrefrot fcrefspiral fcrefsprforcecart fcrefstart fcrefstop fcreftorque"),
    **_kept(_FORCE, "fccondforce fccondorient fccondpos fccondreorispeed fccondtcpspeed"),
    **_kept(_FORCE, "fccondtorque fccondwaitwhile fcresetdampingtune fcresetlpfiltertune"),
    **_kept(_FORCE, "fcsetdampingtune fcsetlpfiltertune fcspdchgact fcspdchgdeact fcspdchgtunset"),
    **_kept(_FORCE, "fcspdchgtunreset fcsupvforce fcsupvorient fcsupvpos fcsupvreorispeed"),
    **_kept(_FORCE, "fcsupvtcpspeed fcsupvtorque fcsetmaxforcechange cssact cssdeact"),
    **_kept(_FORCE, "cssforceoffsetact cssforceoffsetdeact cssoffsettune"),
    **_kept(_LOAD_TEST, "loadid manloadidproc paridposvalid"),
    **_kept(_GUN, "setforce calibrate recalctcp indgunmove indgunmovereset openhighlift"),
    **_kept(_GUN, "closehighlift stcalib stclose stopen stindgun stindgunreset sttune sttunereset"),
    **_kept(_DATA, "triggdatareset triggdatacopy triggstopproc"),
    **_kept(_ZONES, "wzboxdef wzcyldef wzspheredef wzsphdef wzlimjointdef wzhomejointdef"),
    **_kept(_ZONES, "wzdoset wzlimsup wzenable wzdisable wzfree"),
    **_kept(_GRIPPER, "g_init g_calibrate g_jogin g_jogout g_gripin g_gripout g_moveto g_stop"),
    **_kept(_GRIPPER, "g_setmaxspd g_setforce g_vacuumon1 g_vacuumoff1 g_vacuumon2 g_vacuumoff2"),
    **_kept(_GRIPPER, "g_blowon1 g_blowoff1 g_blowon2 g_blowoff2 hand_initialize hand_moveto"),
    **_kept(_GRIPPER, "hand_gripinward hand_gripoutward hand_jogin hand_jogout hand_stop"),
    **_kept(_GRIPPER, "hand_setmaxspeed hand_setforce hand_docalibration hand_turnonvacuum1"),
    **_kept(_GRIPPER, "hand_turnoffvacuum1 hand_turnonvacuum2 hand_turnoffvacuum2"),
    **_kept(_GRIPPER, "hand_turnonblow1 hand_turnoffblow1 hand_turnonblow2 hand_turnoffblow2"),
    **_kept(_GRIPPER, "tclocktool tcunlocktool tcopencover tcclosecover"),
    **_kept(_PROCESS, "arcrefresh arckill arcweldon arcweldoff spotcontrol setbrush setbrushfac"),
    **_kept(_PROCESS, "usebrushtab ipssetparam setwrprocname recoverymenu recoverymenuwr"),
    **_kept(_PROCESS, "capaptrsetup capaptrsetupai capaptrsetupao capaptrsetuppers capcondsetdo"),
    **_kept(_PROCESS, "capequidist capnoprocess caprefresh capsetstopmode capweavesync"),
    **_kept(_PROCESS, "swsetintspotdata swsetintforcedata swsetintgundata swsetintsimdata"),
    **_kept(_PROCESS, "swgetfixtipdata daactproc dadeactproc dadeactallproc dadefextsig"),
    **_kept(_PROCESS, "dadefprocdata dadefprocsig dadefuserdata dagetcurrdata dasetcurrdata"),
    **_kept(_PROCESS, "dasetupappbehav dastartmanaction dagetappdescr dagetappindex"),
    **_kept(_PROCESS, "pmgrsetnextpart hr_savepos"),
    **_kept(_SAFETY, "safetycontrollersyncrequest safetycontrolsync setleadthrough"),
    **_kept(_BRAKES, "brakecheck cyclicbrakecheck"),
}
"""name → why and how it is kept."""


_OUTPUTS: dict[str, tuple[int | str, ...]] = {
    **dict.fromkeys(words("tpreadfk tpreadnum tpreaddnum"), (0, "breakflag")),
    "uimsgbox": ("result", "breakflag"),
    "readcfgdata": (2,),
    "socketaccept": (1, "clientaddress"),
    "socketconnect": (),
    "socketreceive": ("str", "rawdata", "data", "readnoofbytes", "nooffullmessages"),
    "readblock": (1,),
    "readanybin": (1,),
    "readrawbytes": (1,),
    "camgetresult": (1,),
    "unpackrawbytes": (2,),
    **dict.fromkeys(words("searchl searchc searchextj"), (1,)),
}
"""Where an instruction has data that it writes and others: which of its required arguments, counted
from 0, and which options it writes."""


def written(name: str, arguments: Sequence[Argument]) -> list[Argument]:
    """The arguments of an instruction that bring data into the program.

    Args:
        name: of the instruction, lower case.
    """
    outputs = _OUTPUTS.get(name)
    if outputs is None:
        return [*arguments]
    required = [a for a in arguments if a.option is None]
    found = [a for number, a in enumerate(required) if number in outputs]
    return found + [a for a in arguments if a.option in outputs]


def _refused(why: str, names: str) -> dict[str, str]:
    return dict.fromkeys(words(names), why)


REFUSED: dict[str, str] = {
    "movepnp": "pick-and-place moves are not read yet: write the moves out",
    "systemstopaction": "it stops the controller: take it out",
    "warmstart": "it restarts the controller: take it out",
    **_refused(
        "it drives along a path that a sensor recorded, which is not in the text: answer it in "
        "[calls] to step over it",
        "arcrepl arcadaptrepl",
    ),
}
"""name → why it is refused."""
