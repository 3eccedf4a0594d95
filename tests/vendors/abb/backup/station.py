"""Writes backups of ABB controllers, whole ones and damaged ones, for tests."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

RANGES = ((-180, 180), (-90, 150), (-180, 75), (-400, 400), (-125, 120), (-400, 400))
"""deg, of an IRB 4600-40/2.55."""

MAIN = """MODULE MainModule
  PERS tooldata tGripper:=[TRUE,[[12.5,0,180],[1,0,0,0]],[4.5,[0,0,60],[1,0,0,0],0.1,0.2,0.3]];
  TASK PERS wobjdata wTable:=[FALSE,TRUE,"",[[900,0,400],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,-20,20,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p10:=[[100,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC Main()
    MoveAbsJ jHome, v1000, fine, tGripper;
    Pick;
    Log;
  ENDPROC
  PROC Pick()
    MoveJ p10, v1000, z10, tGripper\\WObj:=wTable;
    MoveL Offs(p10,0,200,0), v500, fine, tGripper\\WObj:=wTable;
  ENDPROC
  PROC Log()
    TPWrite "done";
  ENDPROC
  LOCAL PROC Hidden()
    MoveAbsJ jHome, v1000, fine, tGripper;
  ENDPROC
  PROC At(robtarget p)
    MoveL p, v500, fine, tGripper;
  ENDPROC
ENDMODULE
"""
USER = """MODULE user(SYSMODULE)
  PERS num nParts:=3;
  PROC Service()
    Pick;
  ENDPROC
ENDMODULE
"""


@dataclass
class Station:
    """What is written of a station; `write` gives its folder."""

    system: str = "Cell7"
    version: str = "RobotWare Version: 6.08.0134"
    products: Sequence[str] = ("English", "IRB 4600-40/2.55")
    tasks: Mapping[str, tuple[str, Mapping[str, str]]] = field(
        default_factory=lambda: {
            "TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": MAIN, "SYSMOD/user.sys": USER})
        }
    )
    cab_tasks: Sequence[str] = ('-Name "T_ROB1" -Type "NORMAL" -MotionTask',)
    sys: Mapping[str, Sequence[str]] = field(default_factory=dict)
    moc: Mapping[str, Sequence[str]] = field(default_factory=dict)
    eio: Mapping[str, Sequence[str]] = field(default_factory=dict)
    unlisted: Mapping[str, bytes] = field(default_factory=dict)
    end: str = "\r\n"

    def write(self, folder: Path) -> Path:
        """The station below a folder."""
        info = [">>SYSTEM_ID:", self.system, ">>PRODUCTS_ID:", self.version, *self.products]
        files: dict[str, bytes] = {"BACKINFO/program.id": b"x", "BACKINFO/key.id": bytes(range(9))}
        for task, (name, modules) in self.tasks.items():
            info += [f">>{task}: ({name},{'prog' if task == 'TASK1' else ''},)"]
            info += [f"{file} @ {Path(file).stem.lower()}" for file in modules]
            for file, text in modules.items():
                files[f"RAPID/{task}/{file}"] = text.replace("\n", self.end).encode("latin-1")
        info += [">>EOF:"]
        files["BACKINFO/backinfo.txt"] = self.end.join(["# Backup", *info, ""]).encode()
        moc = self.moc or one_robot()
        sys = {"CAB_TASKS": self.cab_tasks, **self.sys}
        for topic, sections in (("MOC", moc), ("SYS", sys), ("EIO", self.eio or SIGNALS)):
            files[f"SYSPAR/{topic}.cfg"] = cfg(topic, sections, self.end).encode("latin-1")
        for name, data in {**files, **self.unlisted}.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        return folder


SIGNALS = {
    "EIO_SIGNAL": (
        '-Name "diStart" -SignalType "DI" -Device "PN" -DeviceMap "0"',
        '-Name "doGrip" -SignalType "DO" -Unit "BOARD10" -UnitMap "3" -Label "close it"',
        '-Name "giPart" -SignalType "GI"',
    )
}


def cfg(topic: str, sections: Mapping[str, Sequence[str]], end: str = "\r\n") -> str:
    """A file of system parameters, long records broken as controllers break them."""
    lines = [f"{topic}:CFG_1.0:6:1::"]
    for section, records in sections.items():
        lines += ["#", f"{section}:", ""]
        for record in records:
            words = record.split(" -")
            broken = [words[0], *(f"-{word}" for word in words[1:])]
            lines += [f"      {part}\\" for part in broken[:-1]] + [f"      {broken[-1]}", ""]
    return end.join([*lines, ""])


def arm_records(
    unit: int = 1, ranges: Sequence[tuple[float, float]] = RANGES
) -> dict[str, list[str]]:
    """JOINT and ARM records of a robot's six axes, ranges in degrees."""
    names = [f"rob{unit}_{axis}" for axis in range(1, 7)]
    bounds = [(math.radians(lower), math.radians(upper)) for lower, upper in ranges]
    return {
        "JOINT": [f'-name "{n}" -logical_axis {k + 1}' for k, n in enumerate(names)],
        "ARM": [
            f'-name "{name}" -upper_joint_bound {upper!r} -lower_joint_bound {lower!r}'
            for name, (lower, upper) in zip(names, bounds, strict=True)
        ],
    }


def robot_record(unit: int = 1, kind: str = "4600_2.55_40", more: str = "") -> str:
    """A ROBOT record."""
    return f'-name "ROB_{unit}" -use_robot_type "ROB{unit}_{kind}" {more}'.rstrip()


PLANNER = (
    '-name "motion_planner_1" -path_resolution 0.66 -linear_max_speed 7.2 '
    "-std_servo_queue_time 0.193536 -dyn_ipol_queue_time 0.064512"
)


def one_robot(
    more: str = "",
    ranges: Sequence[tuple[float, float]] = RANGES,
    kind: str = "4600_2.55_40",
) -> dict[str, Sequence[str]]:
    """MOC.cfg of one robot."""
    return {
        "ROBOT": [robot_record(1, kind, more)],
        **arm_records(1, ranges),
        "MOTION_PLANNER": [PLANNER],
    }


def on_track(base: str = "", single: str = "") -> dict[str, Sequence[str]]:
    """MOC.cfg of a robot on a track of 6 m and beside a turntable."""
    axes = arm_records()
    return {
        "ROBOT": [robot_record(1, more=f'{base} -base_frame_coordinated "TRACK_1"'.strip())],
        "JOINT": [
            *axes["JOINT"],
            '-name "trk_1" -logical_axis 7 -use_arm "trk_arm"',
            '-name "stn_1" -logical_axis 8',
        ],
        "ARM": [
            *axes["ARM"],
            '-name "trk_arm" -lower_joint_bound -0.1 -upper_joint_bound 5.9',
            '-name "stn_1" -lower_joint_bound -3.2 -upper_joint_bound 3.2',
        ],
        "SINGLE": [
            f'-name "TRACK_1" -use_single_type "TRK" -use_joint "trk_1" {single}'.strip(),
            '-name "STN_1" -use_single_type "ROT" -use_joint "stn_1" -base_frame_pos_x 1.5',
        ],
        "SINGLE_TYPE": ['-name "TRK" -mechanics "TRACK"', '-name "ROT" -mechanics "FREE_ROT"'],
        "MECHANICAL_UNIT": [
            '-name "TRACK_1" -use_single_0 "TRACK_1"',
            '-name "STN1" -use_single_0 "STN_1"',
        ],
        "TRANSMISSION": [
            '-name "trk_1" -transm_joint -294.57',
            '-name "stn_1" -transm_joint 120 -rotating_move',
        ],
        "STRESS_DUTY_CYCLE": [
            '-name "trk_1" -speed_absolute_max 314.1',
            '-name "stn_1" -speed_absolute_max 240',
        ],
        "ACC_DATA": [
            '-name "trk_1" -wc_acc 2.38 -wc_dec 2.5',
            '-name "stn_1" -wc_acc 4 -wc_dec 3',
        ],
    }


RIGHT = """MODULE MainModule
  PERS tasks both{2}:=[["T_ROB_R"],["T_ROB_L"]];
  VAR syncident met;
  TASK PERS tooldata grip:=[TRUE,[[0,0,136],[1,0,0,0]],[0.26,[8,12,50],[1,0,0,0],0,0,0]];
  PROC main()
    MoveAbsJ [[0,-130,30,0,40,0],[-135,9E9,9E9,9E9,9E9,9E9]],v1000,fine,grip;
    WaitSyncTask met,both;
    MoveAbsJ [[35,-95,40,80,50,20],[-70,9E9,9E9,9E9,9E9,9E9]],v1000,fine,grip;
    MoveL Offs(CRobT(\\Tool:=grip),0,0,30),v100,fine,grip;
  ENDPROC
ENDMODULE
"""


def yumi(kinds: tuple[str, str] = ("ROB_R_14000_05_05", "ROB_L_14000_05_05")) -> Station:
    """Two arms on one body, each with a task, that wait for each other."""
    bent, mirrored = "[35,-95,40,80,50,20],[-70", "[-35,-95,40,-80,50,-20],[70"
    left = RIGHT.replace("-135", "135").replace(bent, mirrored)
    bounds = (168.5, -168.5), (43.5, -143.5), (80, -123.5), (290, -290), (138, -88), (229, -229)
    turns = "-gravity_alpha {}0.629233 -gravity_beta 0.950657 -gamma_rotation {}0.184266"
    arms, singles, groups = [], [], []
    for side in "RL":
        singles.append(
            f'-name "ROB_{side}_7" -use_single_type "ROB_{side}_7" -use_joint "rob_{side}_7"'
        )
        group = f'-Name "rob_{side.lower()}" -Robot "ROB_{side}" -MechanicalUnit_1 "ROB_{side}_7"'
        groups.append(group)
        for axis, (upper, lower) in enumerate((*bounds, (150, -150)), 1):
            ends = f"-upper_joint_bound {math.radians(upper)!r}"
            ends += f" -lower_joint_bound {math.radians(lower)!r}"
            arms.append(f'-name "rob_{side}_{axis}" {ends}')
    robots = [
        f'-name "ROB_{side}" -use_robot_type "{kind}" '
        + " ".join(f'-use_joint_{k} "rob_{side}_{k + 1}"' for k in range(6))
        + f" {turns.format(sign, sign)}"
        for side, kind, sign in zip("RL", kinds, ("", "-"), strict=True)
    ]
    return Station(
        products=("English", "IRB 14000-0.5/0.5"),
        tasks={
            "TASK1": ("T_ROB_R", {"PROGMOD/MainModule.mod": RIGHT}),
            "TASK2": ("T_ROB_L", {"PROGMOD/MainModule.mod": left}),
        },
        cab_tasks=tuple(
            f'-Name "T_ROB_{side}" -Type "NORMAL" -UseMechanicalUnitGroup "rob_{side}" -MotionTask'
            for side in "RL"
        ),
        sys={"MECHANICAL_UNIT_GROUP": groups},
        moc={"ROBOT": robots, "SINGLE": singles, "ARM": arms},
    )


def renamed(module: str, name: str, entry: str = "Main") -> str:
    """The main module of another task."""
    return module.replace("MainModule", name).replace("PROC Main", f"PROC {entry}")


def multimove() -> Station:
    """Two robots, a table of one of them, and tasks beside them."""
    one, two = arm_records(1), arm_records(2)
    both = {key: [*one[key], *two[key]] for key in one}
    both["JOINT"].append('-name "stn_1" -logical_axis 7')
    both["ARM"].append('-name "stn_1" -lower_joint_bound -3 -upper_joint_bound 3')
    watch = "MODULE Watch\n  PROC Poll()\n    WaitTime 1;\n  ENDPROC\nENDMODULE\n"
    second = renamed(MAIN, "Second", "Start2").replace("[12.5,0,180]", "[0,0,90]")
    return Station(
        tasks={
            "TASK0": ("SHARED", {"SYSMOD/common.sys": "MODULE common(SYSMODULE)\nENDMODULE\n"}),
            "TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": MAIN}),
            "TASK2": ("T_ROB2", {"PROGMOD/Second.mod": second}),
            "TASK3": ("T_WATCH", {"SYSMOD/watch.sys": watch}),
            "TASK4": ("PSC_CBC", {}),
        },
        cab_tasks=(
            '-Name "T_ROB1" -UseMechanicalUnitGroup "rob1" -MotionTask',
            '-Name "T_ROB2" -Entry "start2" -UseMechanicalUnitGroup "second" -MotionTask',
            '-Name "T_WATCH" -Type "STATIC" -Entry "Poll"',
        ),
        sys={
            "MECHANICAL_UNIT_GROUP": (
                '-Name "rob1" -Robot "ROB_1"',
                '-Name "second" -Robot "ROB_2" -MechanicalUnit_1 "STN1"',
            )
        },
        moc={
            "ROBOT": [
                robot_record(1, more="-base_frame_pos_y 1.2"),
                robot_record(2, "120_0.58_3", "-base_frame_pos_y -1.2"),
            ],
            **both,
            "SINGLE": ['-name "STN_1" -use_single_type "ROT" -use_joint "stn_1"'],
            "SINGLE_TYPE": ['-name "ROT" -mechanics "FREE_ROT"'],
            "MECHANICAL_UNIT": ['-name "STN1" -use_single_0 "STN_1"'],
        },
    )


TABLE = """MODULE TableMain
  PROC Main()
    MoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[0,9E9,9E9,9E9,9E9,9E9]],v100,fine;
    MoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[90,9E9,9E9,9E9,9E9,9E9]],v100,fine;
  ENDPROC
ENDMODULE
"""


def with_positioner(made: Station) -> Station:
    """The same with a table that a task of its own turns."""
    moc = {key: list(records) for key, records in (made.moc or one_robot()).items()}
    moc["JOINT"].append('-name "stn_1" -logical_axis 7')
    moc["ARM"].append('-name "stn_1" -lower_joint_bound -3 -upper_joint_bound 3')
    moc["SINGLE"] = ['-name "STN_1" -use_single_type "ROT" -use_joint "stn_1"']
    moc["SINGLE_TYPE"] = ['-name "ROT" -mechanics "FREE_ROT"']
    moc["MECHANICAL_UNIT"] = ['-name "STN1" -use_single_0 "STN_1"']
    return replace(
        made,
        tasks={**made.tasks, "TASK2": ("T_POS1", {"PROGMOD/TableMain.mod": TABLE})},
        cab_tasks=(*made.cab_tasks, '-Name "T_POS1" -UseMechanicalUnitGroup "pos" -MotionTask'),
        sys={"MECHANICAL_UNIT_GROUP": ('-Name "pos" -MechanicalUnit_1 "STN1"',)},
        moc=moc,
    )
