"""Options by name: what they are called, and which values they take."""

import pytest

from flyby.core.errors import InputError, UnknownNameError
from flyby.core.registry import find_vendor
from flyby.core.source.write.options import PatcherOptions, Sharing

MOVES = {
    "abb": "MODULE m\nCONST jointtarget j:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "PROC main()\nMoveAbsJ j,v100,fine,tool0;\nENDPROC\nENDMODULE\n",
    "kuka": "DEF m()\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\nEND\n",
    "ur": "movej([0, -1.5, 1.5, 0, 1.5, 0])\n",
}


def test_what_is_not_named_is_refused_by_default() -> None:
    assert PatcherOptions.of({}, "RAPID patcher") == PatcherOptions(Sharing.REFUSE, Sharing.REFUSE)
    own = PatcherOptions.of({"shared": "own"}, "RAPID patcher")
    assert own == PatcherOptions(shared=Sharing.OWN)


def test_unknown_names_and_values_are_refused() -> None:
    with pytest.raises(UnknownNameError, match=r"RAPID patcher.*did you mean 'shared'"):
        PatcherOptions.of({"share": "own"}, "RAPID patcher")
    with pytest.raises(InputError, match="option derived: one of refuse, own, not 'freeze'"):
        PatcherOptions.of({"derived": "freeze"}, "RAPID patcher")


@pytest.mark.parametrize("name", MOVES)
def test_all_vendors_take_the_same_options(name: str) -> None:
    vendor = find_vendor(name)
    robot = vendor.robot(next(iter(vendor.robots)))
    program = vendor.read(MOVES[name], "m")
    for value in Sharing:
        assert not vendor.patch(program, robot, {"shared": value, "derived": value})
    with pytest.raises(InputError, match="option shared: one of refuse, own, not 'keep'"):
        vendor.patch(program, robot, {"shared": "keep"})
