"""A greatest speed of the TCP that the controller holds, whatever programs state."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.motion.emulator.binding_limits import limit_shares
from flyby.drawing.geometry import tcp_speed
from flyby.tasks.results.runs import Run

NEAR = 2e-3
"""Of a speed that is taken from samples."""


def driven(tmp: str, robot: str, text: str, cap: float | None) -> Run:
    motion = f"{tmp}/motion.toml"
    with open(motion, "w", encoding="utf-8") as file:
        file.write("" if cap is None else f"[limit]\ntcp_speed = {cap}\n")
    return flyby.emulate(flyby.read(text, robot=robot, motion=motion))


def script(speed: float, blend: float, time: str) -> str:
    return (
        "def p():\n  movej([0,-1.2,1.2,0,1,0],a=3,v=3)\n"
        f"  movel(p[-0.9,-0.4,0.5,0,3.14,0],a=6,v={speed},r={blend})\n"
        f"  movel(p[-0.9,0.4,0.5,0,3.14,0],a=6,v={speed}{time},r={blend})\n"
        f"  movej([1.5,-1.2,1.2,0,1,0],a=5,v=3,r={blend})\n  movej([0,-1,1,0,1,0],a=5,v=3)\nend\n"
    )


@settings(max_examples=12, deadline=None)
@given(st.floats(0.2, 3.0), st.floats(0.3, 3.0), st.sampled_from([0.0, 0.05]), st.booleans())
def test_no_move_is_faster(
    tmp_path_factory: pytest.TempPathFactory, cap: float, speed: float, blend: float, timed: bool
) -> None:
    folder = str(tmp_path_factory.mktemp("cap"))
    text = script(speed, blend, ",t=0.3" if timed else "")
    free, held = (driven(folder, "ur/ur20", text, most) for most in (None, cap))
    assert float(tcp_speed(held).max()) <= cap * (1 + NEAR)
    assert held.report.cycle_time >= free.report.cycle_time - 1e-9
    if float(tcp_speed(free).max()) < 0.99 * cap:
        assert held.report.cycle_time == pytest.approx(free.report.cycle_time, abs=1e-6)


def test_what_holds_a_move_is_named(tmp_path) -> None:
    run = driven(str(tmp_path), "ur/ur20", script(2.0, 0.0, ""), 0.25)
    shares = limit_shares(
        run.run if hasattr(run, "run") else run, run.program.setup.robot.axis_names
    )
    assert all(one[0].name == "TCP speed" for one in shares[1:])
    assert float(np.max(tcp_speed(run))) == pytest.approx(0.25, rel=NEAR)
