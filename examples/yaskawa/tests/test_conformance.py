"""Yaskawa passes the conformance suite, and reads jobs as controllers write them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from flyby_yaskawa.language import LEVELS, PL
from flyby_yaskawa.plugin import vendor
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.speed import Speed
from flyby.core.program.zone import VendorZone
from flyby.core.source.execution.answers import Answers
from flyby.testing.conformance import VendorConformance


class TestYaskawa(VendorConformance):
    name = "yaskawa"
    vendor = vendor()  # type: ignore[assignment]
    golden = Path(__file__).parent / "golden.toml"

    def other_speeds(self, move: Move) -> st.SearchStrategy[Speed]:
        """A number is changed where it stands: none is put in, none taken out."""
        own = move.speed
        drawn = self.said_speeds(type(move)).filter(lambda speed: _stated(speed) == _stated(own))
        return drawn.map(lambda s: replace(s, acceleration_override=own.acceleration_override))


def _stated(speed: Speed) -> list[bool]:
    return [value is None for value in (speed.tcp, speed.reorientation)]


JOB = """\
/JOB
//NAME PICK
//POS
///NPOS 5,0,0,0,0,0
///TOOL 0
///POSTYPE PULSE
///PULSE
C00000=0,1000,-2000,0,-4000,0
///POSTYPE BASE
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
C00001=400.000,0.000,100.000,180.0000,0.0000,0.0000
C00002=420.000,20.000,100.000,180.0000,0.0000,0.0000
C00003=400.000,40.000,100.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
SET B000 0
MOVJ C00000 VJ=50.00 PL=0
*AGAIN
MOVL C00001 V=500.0 PL=2 ACC=50 DEC=50
MOVC C00001 V=200.0
MOVC C00002 V=200.0
MOVC C00003 V=200.0 PL=1
DOUT OT#(1) ON
TIMER T=0.50
INC B000
JUMP *AGAIN IF B000<2
END
"""
RATES = Answers(values={f"pulse[1,{k}]": 100.0 for k in range(1, 7)})


def test_a_job_is_read() -> None:
    program = vendor().read(JOB, "pick.jbi", answers=RATES)
    kinds = [type(move) for move in program.moves]
    assert kinds == [MoveJ, MoveL, MoveC, MoveL, MoveC]
    first, line, arc, *_ = program.moves
    assert first.target.joints[1] == pytest.approx(0.17453, abs=1e-4)
    assert line.speed == Speed(tcp=0.5, acceleration_override=0.5)
    assert line.zone == VendorZone(PL, 0.025) and str(line.zone) == "PL 2"
    assert arc.via.pose.position == pytest.approx((0.42, 0.02, 0.1))
    assert arc.zone == VendorZone(PL, 0.0125)


def test_pulses_are_asked_for() -> None:
    with pytest.raises(SourceError, match=r"answer PULSE\[1,1\] to PULSE\[1,6\]"):
        vendor().read(JOB, "pick.jbi")


def test_a_level_is_patched_in_place() -> None:
    program = vendor().read(JOB, "pick.jbi", answers=RATES)
    moves = tuple(
        replace(m, zone=PL.sized(LEVELS[2])) if isinstance(m, MoveL) else m for m in program.moves
    )
    (file,) = vendor().patch(program.with_moves(moves), vendor().robot("gp8")).values()
    assert file.text == JOB.replace("PL=2", "PL=3")
