"""Recorders: the program is driven, a submit program samples, a logger writes the file."""

import math
from pathlib import Path

import pytest

from flyby.core.errors import InputError
from flyby.core.program.move import MoveJ, MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import ContourFraction, Radius
from flyby.core.recording import LOG, Recording
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import difference
from flyby.core.spatial.pose import Pose
from flyby.vendors.kuka.record import record

KUKA = find_vendor("kuka")
ROBOT = KUKA.robot("kr30-3")
HOME = JointTarget(tuple(map(math.radians, (0, -90, 90, 0, 45, 0))))
JOB = Program(
    (
        MoveJ(HOME, Speed(joint_fraction=0.5), ContourFraction(0.5)),
        Opaque("$OUT[5]=TRUE", stops=True),
        MoveL(
            PoseTarget(Pose((1.3, 0.0, 1.2), (0.0, 0.0, 1.0, 0.0))),
            Speed(tcp=0.25),
            Radius(0.01, 0.01, 0.01),
        ),
    ),
    "Job",
)


def test_what_is_recorded_drives_the_same_moves(tmp_path: Path) -> None:
    files = record(Recording.of(JOB), ROBOT, 0.024)
    assert set(files) == {
        *("Job.src", "Job.dat", "flyby_log.src", "flyby_log.dat", "flyby_rec.sub"),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, "utf-8")
    again = KUKA.read_file(tmp_path / "Job.src", robot=ROBOT)
    assert difference(Program(JOB.moves), Program(again.moves)) is None


def test_the_logger_begins_before_the_first_and_ends_after_the_last_motion() -> None:
    lines = record(Recording.of(JOB), ROBOT, 0.012)["Job.src"].splitlines()
    begin, end = lines.index("FLYBY_LOG(#FB_BEGIN)"), lines.index("FLYBY_LOG(#FB_END)")
    motions = [k for k, line in enumerate(lines) if line.startswith(("PTP ", "LIN "))]
    assert begin < motions[0] and motions[-1] < end
    assert lines[end - 1].startswith("WAIT SEC"), "the advance run must not end it early"
    assert lines[begin - 1] == f'FB_NAME[]="{LOG}"' and "; $OUT[5]=TRUE" in lines


def test_the_sampler_takes_the_measured_axes_at_the_period() -> None:
    sampler = record(Recording.of(JOB), ROBOT, 0.036)["flyby_rec.sub"]
    assert "FB_Q[FB_N]=$AXIS_ACT_MEAS" in sampler and "FB_NEXT=FB_NEXT+36" in sampler
    logger = record(Recording.of(JOB), ROBOT, 0.036)["flyby_log.src"]
    assert '"krl_fopen",FB_NAME[],"w"' in logger and '"t,q1,q2,q3,q4,q5,q6"' in logger
    assert f"FB_Q[I].A6*{math.radians(1):.10f}" in logger


@pytest.mark.parametrize("period", [0.0, 0.004, -1.0, math.nan, math.inf])
def test_periods_below_the_cycle_are_refused(period: float) -> None:
    with pytest.raises(InputError, match=r"0\.012 s or more"):
        record(Recording.of(JOB), ROBOT, period)
