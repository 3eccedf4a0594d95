"""Which robot comes first may hang on less than the jitter: in time is proven of each."""

from __future__ import annotations

import pytest

import flyby
from flyby.core.errors import MotionError

from .stations import UNUSED, Write

AWAY, NEAR = (f"MoveAbsJ [[{angle},0,0,0,30,0],{UNUSED}], v1000, fine, tool0" for angle in (90, 0))
LOCK = "".join(
    f'[logic.{own}]\nand = ["{own}.doAsk", "not plc.{other}"]\nto = "{own}.diGo"\n'
    for own, other in (("one", "two"), ("two", "one"))
)


def asked(write: Write, late: float):
    """One asks, and turns to the other; two asks a little later, and then stands for a second.

    If two gets its turn first, both turn to each other at one time behind it.
    """
    ask = ("SetDO doAsk,1", "WaitDI diGo,1")
    one = [AWAY, *ask, NEAR, AWAY, "SetDO doAsk,0"]
    two = [AWAY, f"WaitTime {late}", *ask, "WaitTime 1", "SetDO doAsk,0", NEAR, AWAY]
    return write({"one": one, "two": two}, LOCK, gap=650.0)


@pytest.mark.parametrize(("late", "proven"), [(0.03, False), (0.2, True)])
def test_both_orders_are_proven_where_the_jitter_says_which(
    write: Write, late: float, proven: bool
) -> None:
    file = asked(write, late)
    made = flyby.station(file)
    (pair,) = made.clearances
    assert pair.in_time.proven is proven and not pair.safe
    assert any("which robot comes first" in str(note) for note in made.notes) is not proven
    assert flyby.station(file, jitter=0.01).clearances[0].in_time.proven
    if not proven:
        with pytest.raises(MotionError, match=r"as they are: .* collide"):
            flyby.station_zones(file)
