"""Figures that no log shows are called as an engineer calls them."""

from __future__ import annotations

import pytest

from flyby.identification.fit.intervals import NO_RUN, Unseen
from flyby.tasks.results.unseen_figures import unseen_said

AXES = ("J1", "J2", "J3", "J4", "J5", "J6")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("limit.joint_acceleration_scale[3]", "never reach J4's acceleration limit; it stays"),
        ("limit.joint_acceleration_scale[3:]", "the acceleration limits of J4, J5, J6"),
        ("limit.joint_acceleration_scale[0:2]", "the acceleration limits of J1, J2"),
        ("limit.tcp_acceleration", "never reach the TCP's acceleration limit"),
        ("time.settling_s", f"time.settling_s is not identifiable: {NO_RUN}"),
    ],
)
def test_what_no_run_comes_to_is_said(name: str, said: str) -> None:
    told = unseen_said(Unseen(name, NO_RUN, unused=True), AXES)
    assert said in told and told.count("it stays as it was") == 1


def test_what_logs_show_only_together_is_said_as_it_is() -> None:
    one = Unseen("limit.joint_acceleration_scale[3]", "the logs show it only together")
    assert "is not identifiable: the logs show it only together" in unseen_said(one, AXES)
