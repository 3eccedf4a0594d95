"""Writes the data lists that a controller would have of an arm, in the ways of several versions."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from flyby.core.robot.model import Robot

DIRECTIONS = (-1, 1, 1, -1, -1, -1)
GEAR, MOTOR = 180, 3600.0
FILTER_MS = 144.0
ZERO = "{X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}"


def machine_data(
    robot: Robot,
    name: str = "#KR6R900 C4SR FLR 230",
    *,
    root: str = ZERO,
    extra: str = "",
    raise_time: bool = False,
    num_ax: int = 6,
) -> str:
    """``$machine.dat`` of an arm whose axes are as the lists of KUKA's arms have them."""
    lengths = _lengths(robot)
    shown = {key: f"{value:.9g}" for key, value in lengths.items()}
    lines = [
        "&ACCESS RVP",
        "DEFDAT  $MACHINE PUBLIC",
        "CHAR $TRAFONAME[32]",
        f'$TRAFONAME[]="{name}"',
        f"INT $NUM_AX={num_ax} ;number of axes",
        "BOOL $DEF_A4FIX=FALSE",
        f"$ROBROOT={root} ;frame between robot and world",
        f"$TIRORO={{X 0.0,Y 0.0,Z {shown['height']},A 0.0,B 0.0,C 0.0}}",
        f"$LENGTH_A={shown['a']} ;mm",
        f"$LENGTH_B={shown['b']}",
        f"$TX3P3={{FRAME: X {shown['forearm']},Y 0.0,Z {shown['offset']},A 0.0,B 90.0,C 0.0}}",
        "$DH_4={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA 90.0}",
        "$DH_5={DHART_A 0.0,DHART_D 0.0,DHART_ALPHA -90.0}",
        f"$TFLWP={{X 0.0,Y 0.0,Z {shown['flange']},A 0.0,B 0.0,C 0.0}}",
        f"$DEF_FLT_PTP={FILTER_MS:g}",
        "INT $DEF_FLT_CP=96 ;ms",
    ]
    for i, (joint, sign) in enumerate(zip(robot.joints, DIRECTIONS, strict=True), 1):
        # 6 · rpm · 1 / gear degrees/s
        rpm = math.degrees(joint.velocity) * GEAR / 6.0
        jerk = math.degrees(joint.acceleration) * 20.0 / (1e-3 * FILTER_MS)
        raised = 1e3 * joint.velocity / joint.acceleration
        lines += [
            f"$AXIS_TYPE[{i}]=3",
            f"$VEL_AXIS_MA[{i}]={rpm:.9f} ;rpm",
            f"$RAT_MOT_AX[{i}]={{N -{GEAR},D 1}}",
            f"$SOFTN_END[{i}]={math.degrees(joint.lower):.9f}",
            f"$SOFTP_END[{i}]={math.degrees(joint.upper):.9f}",
            f"$AXIS_DIR[{i}]={sign}",
            f"$MAMES[{i}]={10 * i}.0",
            f"$RAISE_TIME[{i}]={raised:.6f}" if raise_time else f"$AXIS_JERK[{i}]={jerk:.6f}",
        ]
    return "\n".join([*lines, extra, "ENDDAT", ""])


def older(text: str) -> str:
    """The same as a KR C2 has it: without comments, components in lower case."""
    lines = [line.partition(";")[0].rstrip() for line in text.split("\n")]
    return "\n".join(
        head + sign + struct.lower() if struct.startswith("{") else line
        for line in lines
        for head, sign, struct in [line.partition("=")]
    )


def external_axis(
    i: int, *, linear: bool, lower: float, upper: float, speed: float, sign: int = 1
) -> str:
    """Limits of axis i, from 7: degrees or mm, per s."""
    turn = 1000.0 if linear else 360.0
    return "\n".join(
        [
            f"$AXIS_TYPE[{i}]={1 if linear else 3}",
            f"$VEL_AXIS_MA[{i}]=3000.0",
            f"$RAT_MOT_AX[{i}]={{N {turn * 50.0 / speed:.9f},D 1.0}}",
            f"$SOFTN_END[{i}]={lower}",
            f"$SOFTP_END[{i}]={upper}",
            f"$AXIS_DIR[{i}]={sign}",
        ]
    )


def robcor(name: str, payload: float) -> str:
    """``$robcor.dat``."""
    return "\n".join(
        [
            "&ACCESS RVP",
            "DEFDAT  $ROBCOR PUBLIC",
            f'$MODEL_NAME[]="{name}"',
            f"DEF_L_M={payload} ;kg",
            "DEF_L_CM={X 100.0,Y 0.0,Z 150.0,A 0.0,B 0.0,C 0.0}",
            "ENDDAT",
            "",
        ]
    )


def write(folder: Path, name: str, text: str) -> Path:
    """A file as controllers write it: CR LF, Latin-1."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / name
    file.write_bytes(text.replace("\n", "\r\n").encode("latin-1"))
    return file


def _lengths(robot: Robot) -> dict[str, float]:
    """mm."""
    at, origins = np.zeros(3), []
    for joint in robot.joints:
        at = at + np.array(joint.placement.position)
        origins.append(1e3 * at)
    tip = 1e3 * np.array(robot.flange.position) + origins[5]
    return {
        "height": origins[1][2],
        "a": origins[1][0],
        "b": origins[2][0] - origins[1][0],
        "forearm": origins[4][0] - origins[2][0],
        "offset": origins[4][2] - origins[2][2],
        "flange": tip[0] - origins[4][0],
    }
