"""What RAPID has without being declared.

Source: ABB, Technical reference manual, RAPID Instructions, Functions and Data types
(3HAC050917-001), and RAPID Overview (3HAC050947-001).
"""

from __future__ import annotations

RECORDS = {
    "pos": {"x": "num", "y": "num", "z": "num"},
    "orient": {"q1": "num", "q2": "num", "q3": "num", "q4": "num"},
    "pose": {"trans": "pos", "rot": "orient"},
    "confdata": {"cf1": "num", "cf4": "num", "cf6": "num", "cfx": "num"},
    "robjoint": {f"rax_{i}": "num" for i in range(1, 7)},
    "extjoint": {f"eax_{c}": "num" for c in "abcdef"},
    "robtarget": {"trans": "pos", "rot": "orient", "robconf": "confdata", "extax": "extjoint"},
    "jointtarget": {"robax": "robjoint", "extax": "extjoint"},
    "speeddata": {"v_tcp": "num", "v_ori": "num", "v_leax": "num", "v_reax": "num"},
    "zonedata": {
        "finep": "bool",
        "pzone_tcp": "num",
        "pzone_ori": "num",
        "pzone_eax": "num",
        "zone_ori": "num",
        "zone_leax": "num",
        "zone_reax": "num",
    },
    "loaddata": {
        "mass": "num",
        "cog": "pos",
        "aom": "orient",
        "ix": "num",
        "iy": "num",
        "iz": "num",
    },
    "tooldata": {"robhold": "bool", "tframe": "pose", "tload": "loaddata"},
    "wobjdata": {
        "robhold": "bool",
        "ufprog": "bool",
        "ufmec": "string",
        "uframe": "pose",
        "oframe": "pose",
    },
}
_ATOMS = (
    "num dnum bool string byte errnum intnum clock iodev identno signaldi signaldo signalai "
    "signalao signalgi signalgo triggdata stoppointdata mecunit opnum switch"
)
ATOMS = set(_ATOMS.split())
SAME = {"errnum": "num", "intnum": "num", "byte": "num", "identno": "num", "opnum": "num"}
PERSISTENT = {"tooldata", "wobjdata"}  # "must be defined as a persistent variable"

SPEEDS = (
    "v5 v10 v20 v30 v40 v50 v60 v80 v100 v150 v200 v300 v400 v500 v600 v800 v1000 v1500 v2000 "
    "v2500 v3000 v4000 v5000 v6000 v7000 vmax"
)
ZONES = "fine z0 z1 z5 z10 z15 z20 z30 z40 z50 z60 z80 z100 z150 z200"
PREDEFINED = (
    dict.fromkeys(SPEEDS.split(), "speeddata")
    | dict.fromkeys(ZONES.split(), "zonedata")
    | {"tool0": "tooldata", "wobj0": "wobjdata", "load0": "loaddata", "pi": "num"}
    | dict.fromkeys(("inpos20", "inpos50", "inpos100"), "stoppointdata")
    | {"errno": "errnum", "intno": "intnum", "edge": "num", "high": "num", "low": "num"}
)

_MOVE_TAIL = (
    r"Speed:speeddata [\V:num]|[\T:num] Zone:zonedata [\Z:num] [\Inpos:stoppointdata] "
    r"Tool:tooldata [\WObj:wobjdata] [\Corr] [\TLoad:loaddata]"
)
_ABSJ_TAIL = _MOVE_TAIL.replace(r" [\Corr]", "")
_DO_TAIL = (
    r"Speed:speeddata [\T:num] Zone:zonedata Tool:tooldata [\WObj:wobjdata] Signal:signaldo "
    r"Value:num [\TLoad:loaddata]"
)
_TRIGGS = r"[\T2:triggdata] [\T3:triggdata] [\T4:triggdata] [\T5:triggdata] [\T6:triggdata]"
_TRIGG_TAIL = (
    rf"Speed:speeddata [\T:num] Trigg_1:triggdata {_TRIGGS} Zone:zonedata "
    r"[\Inpos:stoppointdata] Tool:tooldata [\WObj:wobjdata] [\Corr] [\TLoad:loaddata]"
)
INSTRUCTIONS = rf"""
MoveAbsJ [\Conc] ToJointPos:jointtarget [\ID:identno] [\NoEOffs] {_ABSJ_TAIL}
MoveJ [\Conc] ToPoint:robtarget [\ID:identno] {_ABSJ_TAIL}
MoveL [\Conc] ToPoint:robtarget [\ID:identno] {_MOVE_TAIL}
MoveC [\Conc] CirPoint:robtarget ToPoint:robtarget [\ID:identno] {_MOVE_TAIL}
MoveJDO ToPoint:robtarget [\ID:identno] {_DO_TAIL}
MoveLDO ToPoint:robtarget [\ID:identno] {_DO_TAIL}
MoveCDO CirPoint:robtarget ToPoint:robtarget [\ID:identno] {_DO_TAIL}
TriggJ [\Conc] ToPoint:robtarget [\ID:identno] {_TRIGG_TAIL}
TriggL [\Conc] ToPoint:robtarget [\ID:identno] {_TRIGG_TAIL}
TriggC [\Conc] CirPoint:robtarget ToPoint:robtarget [\ID:identno] {_TRIGG_TAIL}
TriggIO TriggData:triggdata Distance:num [\Start]|[\Time] [\DOp:signaldo]|[\GOp:signalgo]|[\AOp:signalao] SetValue:num [\DODelay:num]
TriggEquip TriggData:triggdata Distance:num [\Start] EquipLag:num [\DOp:signaldo]|[\GOp:signalgo]|[\AOp:signalao] SetValue:num
AccSet Acc:num Ramp:num [\FinePointRamp:num]
VelSet Override:num Max:num
PathAccLim AccLim:bool [\AccMax:num] DecelLim:bool [\DecelMax:num]
WorldAccLim [\On:num]|[\Off]
ConfJ [\On]|[\Off]
ConfL [\On]|[\Off]
SingArea [\Wrist]|[\LockAxis4]|[\Arm]|[\Off]
CirPathMode [\PathFrame]|[\ObjectFrame]|[\CirPointOri]|[\Wrist45]|[\Wrist46]|[\Wrist56]
GripLoad Load:loaddata
ActUnit MechUnit:mecunit
DeactUnit MechUnit:mecunit
WaitTime [\InPos] Time:num
WaitRob [\InPos]|[\ZeroSpeed]
WaitUntil [\InPos] Cond:bool [\MaxTime:num] [\TimeFlag:bool] [\PollRate:num]
WaitDI Signal:signaldi Value:num [\MaxTime:num] [\TimeFlag:bool]
WaitDO Signal:signaldo Value:num [\MaxTime:num] [\TimeFlag:bool]
SetDO [\SDelay:num]|[\Sync] Signal:signaldo Value:num
SetAO Signal:signalao Value:num
SetGO [\SDelay:num] Signal:signalgo Value:num
Set Signal:signaldo
Reset Signal:signaldo
PulseDO [\High] [\PLength:num] Signal:signaldo
TPErase
TPWrite String:string [\Num:num]|[\Bool:bool]|[\Pos:pos]|[\Orient:orient]|[\Dnum:dnum]
Stop [\NoRegain]|[\AllMoveTasks]
Incr Name:num
Decr Name:num
Add Name:num AddValue:num
Clear Name:num
ClkReset Clock:clock
ClkStart Clock:clock
ClkStop Clock:clock
Open Object:string [\File:string] IODevice:iodev [\Read]|[\Write]|[\Append] [\Bin]
Close IODevice:iodev
Write IODevice:iodev String:string [\Num:num]|[\Bool:bool]|[\Pos:pos]|[\Orient:orient]|[\Dnum:dnum] [\NoNewLine]
ITimer [\Single]|[\SingleSafe] Time:num Interrupt:intnum
ISignalDI [\Single]|[\SingleSafe] Signal:signaldi TriggValue:num Interrupt:intnum
IDelete Interrupt:intnum
IDisable
IEnable
ISleep Interrupt:intnum
IWatch Interrupt:intnum
StopMove [\Quick]
StartMove
EOffsOff
EOffsSet EAxOffs:extjoint
PDispOff
PDispSet DispFrame:pose
RemoveFile Path:string
"""  # noqa: E501
_MATHS = "abs sqrt sin cos tan asin acos atan atan2 pow exp round trunc"
FUNCTIONS = {
    "offs": "robtarget",
    "reltool": "robtarget",
    "crobt": "robtarget",
    "cjointt": "jointtarget",
    "calcrobt": "robtarget",
    "calcjointt": "jointtarget",
    "cpos": "pos",
    "orientzyx": "orient",
    "eulerzyx": "num",
    "posemult": "pose",
    "poseinv": "pose",
    "posevect": "pos",
    "numtostr": "string",
    "valtostr": "string",
    "strpart": "string",
    "strlen": "num",
    "clkread": "num",
    "dim": "num",
    "cdate": "string",
    "ctime": "string",
    "gettime": "num",
    "isfile": "bool",
    "doutput": "num",
    "dinput": "num",
    "testdi": "bool",
    **dict.fromkeys(_MATHS.split(), "num"),
}
