"""Trajectories: resampling, files there and back, and broken files."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.command.trajectory import Trajectory, sample_times
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot
from flyby.identification.logs import read_samples

ARRAYS = ("t", "q", "dq", "ddq", "position", "quaternion", "sigma", "move")
MOTORS = ("q_motor", "dq_motor", "ddq_motor")


@pytest.fixture(scope="module")
def motion(abb) -> Trajectory:
    speed = Speed(tcp=0.3)
    moves = (
        MoveL(abb.target((1, 0, 0), (0.2, 0, 0)), speed, Radius(0.05)),
        MoveL(abb.target((1, 1, 0)), speed, FINE),
    )
    return abb.controller().run(Program(moves, start=abb.start)).trajectory


def leads_of(motion: Trajectory) -> tuple[np.ndarray, ...]:
    made = 1e-3 * np.sin(np.arange(6.0)) * motion.ddq, 0.5 * motion.dq, -2.0 * motion.ddq
    return tuple(part.astype(np.float32) for part in made)


def test_csv_there_and_back(motion, tmp_path) -> None:
    path = tmp_path / "motion.csv"
    motion.save_csv(path)
    header = path.read_text("utf-8").splitlines()[0]
    assert header == "t,q1,q2,q3,q4,q5,q6,x,y,z,qw,qx,qy,qz,move"
    back = Trajectory.load_csv(path)
    for name in ("t", "q", "position", "quaternion"):
        np.testing.assert_allclose(getattr(back, name), getattr(motion, name), atol=1e-8)
    np.testing.assert_array_equal(back.move, motion.move)
    np.testing.assert_allclose(back.dq[2:-2], motion.dq[2:-2], atol=0.02)


def test_npz_there_and_back_is_exact(motion, tmp_path) -> None:
    path = tmp_path / "motion.npz"
    motion.save_npz(path)
    back = Trajectory.load_npz(path)
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(back, name), getattr(motion, name))
    assert back.lead is None


def test_motors_are_written_where_they_differ(motion, tmp_path) -> None:
    led = replace(motion, lead=leads_of(motion))
    led.save_csv(tmp_path / "led.csv")
    header = (tmp_path / "led.csv").read_text("utf-8").splitlines()[0]
    motors = ",".join(f"q{j}_motor" for j in range(1, 7))
    assert header == f"t,q1,q2,q3,q4,q5,q6,x,y,z,qw,qx,qy,qz,move,{motors}"
    back = Trajectory.load_csv(tmp_path / "led.csv")
    for name in ("t", "q", "position", "quaternion", "q_motor"):
        np.testing.assert_allclose(getattr(back, name), getattr(led, name), atol=1e-8)
    np.testing.assert_array_equal(back.move, motion.move)
    led.save_npz(tmp_path / "led.npz")
    back = Trajectory.load_npz(tmp_path / "led.npz")
    for name in (*ARRAYS, *MOTORS):
        np.testing.assert_array_equal(getattr(back, name), getattr(led, name))
    log = read_samples(tmp_path / "led.csv", find_robot("abb/irb6640-180-255"))
    np.testing.assert_allclose(log.q, led.q_motor, atol=1e-8)


def test_half_of_the_motors_is_no_trajectory(motion, tmp_path) -> None:
    arrays = {name: getattr(motion, name) for name in ARRAYS}
    np.savez(tmp_path / "half.npz", q_motor=motion.q, **arrays)
    with pytest.raises(InputError, match="no dq_motor, ddq_motor"):
        Trajectory.load_npz(tmp_path / "half.npz")
    with pytest.raises(InputError, match="q_motor"):
        replace(motion, lead=(leads_of(motion)[0][:-1], *leads_of(motion)[1:]))


def test_motors_are_resampled_as_links_are(motion) -> None:
    lead = (motion.q - motion.q[0], motion.dq, motion.ddq)
    made = replace(motion, lead=tuple(part.astype(np.float32) for part in lead)).resampled(0.003)
    np.testing.assert_allclose(made.q_motor, 2 * made.q - motion.q[0], atol=1e-6)
    np.testing.assert_allclose(made.dq_motor, 2 * made.dq, atol=1e-4)
    np.testing.assert_allclose(made.ddq_motor, 2 * made.ddq, atol=1e-5)


def test_files_are_written_whole_or_not_at_all(motion, tmp_path) -> None:
    with pytest.raises((InputError, OSError)):
        motion.save_csv(tmp_path / "nowhere" / "motion.csv")
    assert list(tmp_path.iterdir()) == []


BROKEN = {
    "header": ("t,a,b", 1),
    "numbers expected": (
        "t,q1,x,y,z,qw,qx,qy,qz,move\n0,0,0,0,0,1,0,0,0,1\n0.1,oops,0,0,0,1,0,0,0,1",
        3,
    ),
    "numbers expected ": ("t,q1,x,y,z,qw,qx,qy,qz,move\n0,0,0,0,0,1,0,0,0", 2),
    "times must increase": (
        "t,q1,x,y,z,qw,qx,qy,qz,move\n0,0,0,0,0,1,0,0,0,1\n0,0,0,0,0,1,0,0,0,1",
        3,
    ),
}


@pytest.mark.parametrize("message", BROKEN)
def test_broken_csv_is_named_by_file_and_line(message, tmp_path) -> None:
    text, line = BROKEN[message]
    path = tmp_path / "broken.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=rf"broken\.csv:{line}: .*{message.strip()}"):
        Trajectory.load_csv(path)


@pytest.mark.parametrize("text", ["", "t,q1,x,y,z,qw,qx,qy,qz,move\n", "\x00\xff"])
def test_an_empty_csv_is_refused(text, tmp_path) -> None:
    path = tmp_path / "empty.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError):
        Trajectory.load_csv(path)


def test_csv_with_nan_is_refused(tmp_path) -> None:
    path = tmp_path / "nan.csv"
    path.write_text(
        "t,q1,x,y,z,qw,qx,qy,qz,move\n0,0,0,0,0,1,0,0,0,1\n0.1,nan,0,0,0,1,0,0,0,1\n", "utf-8"
    )
    with pytest.raises(InputError, match="finite"):
        Trajectory.load_csv(path)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 broken", b"no archive"])
def test_broken_npz_is_refused(content, tmp_path) -> None:
    path = tmp_path / "broken.npz"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"broken\.npz"):
        Trajectory.load_npz(path)


def test_npz_without_an_array_is_refused(motion, tmp_path) -> None:
    path = tmp_path / "part.npz"
    np.savez(path, t=motion.t, q=motion.q)
    with pytest.raises(InputError, match=r"part\.npz"):
        Trajectory.load_npz(path)


@pytest.mark.parametrize("load", [Trajectory.load_csv, Trajectory.load_npz])
def test_missing_files_are_named(load, tmp_path) -> None:
    with pytest.raises(InputError, match="absent"):
        load(tmp_path / "absent")


@settings(max_examples=15, deadline=None)
@given(period=st.floats(0.001, 0.02))
def test_resampling_keeps_the_motion(motion, period) -> None:
    other = motion.resampled(period)
    assert other.t[0] == motion.t[0] and other.t[-1] == motion.t[-1]
    assert np.diff(other.t).max() <= period * (1 + 1e-9)
    for k in range(6):
        back = np.interp(other.t, motion.t, motion.q[:, k])
        np.testing.assert_allclose(other.q[:, k], back, atol=2e-4)
    np.testing.assert_allclose(np.linalg.norm(other.quaternion, axis=1), 1.0)


def test_resampling_at_the_own_period_changes_nothing(motion) -> None:
    same = motion.resampled(0.004)
    for name in ("t", "q", "dq", "position", "sigma"):
        np.testing.assert_allclose(getattr(same, name), getattr(motion, name), atol=1e-9)


@settings(max_examples=40, deadline=None)
@given(duration=st.floats(1e-3, 30), period=st.floats(1e-3, 1.0))
def test_sample_times_end_exactly_and_leave_no_sliver(duration, period) -> None:
    t = sample_times(0.0, duration, period)
    assert t[0] == 0.0 and t[-1] == duration
    assert (np.diff(t) > 0).all()
    assert np.diff(t).max() <= period * 1.0011


def test_what_is_no_trajectory_is_refused(motion) -> None:
    parts = {name: getattr(motion, name) for name in ARRAYS}
    for change in (
        {"t": motion.t[::-1]},
        {"q": motion.q[:-1]},
        {"position": np.full_like(motion.position, np.nan)},
    ):
        with pytest.raises(InputError):
            Trajectory(**{**parts, **change})
    with pytest.raises(InputError):
        Trajectory(**{name: array[:0] for name, array in parts.items()})
    with pytest.raises(InputError):
        motion.resampled(0.0)


HEADER = "t,q1,x,y,z,qw,qx,qy,qz,move\n0,0,0,0,0,1,0,0,0,1\n"


@pytest.mark.parametrize("row", ["0.1", "0.1,0,0,0,0,1,0,0,0,1,7", "0.1,inf,0,0,0,1,0,0,0,1"])
def test_a_row_of_another_length_or_without_meaning_is_named(row, tmp_path) -> None:
    path = tmp_path / "broken.csv"
    path.write_text(HEADER + row, "utf-8")
    with pytest.raises(InputError, match=r"broken\.csv:3: "):
        Trajectory.load_csv(path)


def test_damaged_archives_and_other_arrays_are_refused(motion, tmp_path) -> None:
    sound = tmp_path / "sound.npz"
    motion.save_npz(sound)
    content = bytearray(sound.read_bytes())
    content[200:400] = bytes(200)
    (tmp_path / "damaged.npz").write_bytes(content)
    np.save(tmp_path / "single.npy", np.zeros(3))
    np.savez(tmp_path / "scalars.npz", **dict.fromkeys(ARRAYS, 1.0))
    np.savez(tmp_path / "objects.npz", **dict.fromkeys(ARRAYS, np.array([{}], dtype=object)))
    for name in ("damaged.npz", "single.npy", "scalars.npz", "objects.npz"):
        with pytest.raises(InputError, match=name) as caught:
            Trajectory.load_npz(tmp_path / name)
        assert "pickle" not in str(caught.value)


@pytest.mark.parametrize("period", [0.0, -1.0, float("nan"), float("inf"), 1e-15])
def test_periods_that_no_sampling_has_are_refused(motion, period) -> None:
    with pytest.raises(InputError, match="period"):
        motion.resampled(period)


@given(
    end=st.floats(0.0, 3.0),
    period=st.floats(0.003, 0.7),
    first=st.floats(-1.0, 4.0),
    length=st.floats(0.0, 3.0),
)
def test_times_of_a_stretch_are_those_of_the_whole(end, period, first, length) -> None:
    whole = sample_times(0.0, end, period)
    some = sample_times(0.0, end, period, (first, first + length))
    at = int(np.searchsorted(whole, some[0]))
    np.testing.assert_array_equal(some, whole[at : at + len(some)])
    missed = np.setdiff1d(whole, some)
    assert not ((missed >= first) & (missed <= first + length)).any()


def test_a_stretch_of_a_long_while_is_sampled() -> None:
    assert len(sample_times(0.0, 1e7, 1e-3, (5.0, 6.0))) < 1_005
    with pytest.raises(InputError, match="samples"):
        sample_times(0.0, 1e7, 1e-3)
