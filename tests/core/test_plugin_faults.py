"""What fails of one plugin is named as its fault, and hinders no other."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from flyby.core.errors import InputError, PluginFault, SourceError, Span
from flyby.core.hookspec import hookimpl
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.registry import Registry, find_robot
from flyby.core.vendor import Vendor


def fails(*_: object) -> Any:
    raise ZeroDivisionError("by nought")


def discovered(vendor: Vendor) -> Registry:
    module = ModuleType("odd")

    @hookimpl
    def flyby_register_vendors(register: Any) -> None:
        register.add(vendor)

    module.flyby_register_vendors = flyby_register_vendors  # type: ignore[attr-defined]
    dist = SimpleNamespace(name="flyby-odd", version="1.0")
    point: Any = SimpleNamespace(name="odd", dist=dist, load=lambda: module)
    found = Registry.discover([point])
    assert found.broken == ()
    return found


def odd(**parts: Any) -> Vendor:
    return Vendor("odd", **{"robots": {"one": fails}, "motion": fails, "label": fails, **parts})


@pytest.mark.parametrize(("load", "said"), [(fails, "ZeroDivisionError"), (lambda: 3, "no Robot")])
def test_a_robot_that_cannot_be_loaded_names_the_plugin(load: Any, said: str) -> None:
    registry = discovered(odd(robots={"one": load}))
    with pytest.raises(InputError, match=rf"flyby-odd 1.0 is at fault: robot odd/one: .*{said}"):
        registry.find_robot("odd/one")


def test_a_language_that_fails_names_the_plugin() -> None:
    """What users hear of is no traceback; errors that say what is wrong stay as they are."""
    broken = SimpleNamespace(read=fails, read_file=fails, write=fails, patch=fails)
    parts = {"reader": broken, "writer": broken, "patcher": broken, "suffixes": (".odd",)}
    vendor = discovered(odd(**parts)).find_vendor("odd")
    robot, start = find_robot("ur/ur5e"), JointTarget((0.0,) * 6)
    program = Program((MoveJ(start, Speed(joint_fraction=0.5)),))
    asked: dict[str, Callable[[], Any]] = {
        "the reader of odd": lambda: vendor.read("x", "a.odd"),
        "the writer of odd": lambda: vendor.write(program, robot),
        "the patcher of odd": lambda: vendor.patch(program, robot),
        "the label of odd": lambda: vendor.label(robot, np.zeros(6)),
    }
    for what, ask in asked.items():
        said = f"the plugin flyby-odd 1.0 is at fault: {what}: ZeroDivisionError: by nought"
        with pytest.raises(InputError, match=f"^{said}"):
            ask()

    def refuses(*_: object) -> Any:
        raise SourceError("no such word", Span("a.odd", 3, 1, 0, 0))

    speaks = discovered(
        odd(reader=SimpleNamespace(read=refuses, read_file=refuses), suffixes=(".odd",))
    )
    with pytest.raises(SourceError, match=r"^a\.odd:3:1: no such word"):
        speaks.find_vendor("odd").read("x", "a.odd")


@pytest.mark.parametrize("listed", [fails, lambda: {"one": 3}])
def test_a_list_of_arms_that_fails_leaves_the_names(
    listed: Any, caplog: pytest.LogCaptureFixture
) -> None:
    registry = discovered(odd(listed=listed))
    with caplog.at_level(logging.WARNING, "flyby"):
        assert [arm.name for arm in registry.robots_like("one")] == ["odd/one"]
    assert "flyby-odd 1.0 is at fault: its list of arms" in caplog.text


@pytest.mark.parametrize("opener", [fails, lambda: 3, lambda: SimpleNamespace(root_in=fails)])
def test_an_opener_that_fails_marks_nothing(opener: Any, caplog: pytest.LogCaptureFixture) -> None:
    backups = discovered(odd(backups=opener)).find_vendor("odd").backups
    assert backups is not None
    with caplog.at_level(logging.WARNING, "flyby"):
        assert backups().root_in(["a"]) is None
    assert "flyby-odd 1.0 is at fault: its opener of backups" in caplog.text


def test_whatever_a_plugin_raises_hides_no_other() -> None:
    class Odd(BaseException):
        pass

    def load() -> None:
        raise Odd("no exception")

    dist = SimpleNamespace(name="flyby-odd", version="1.0")
    point: Any = SimpleNamespace(name="odd", dist=dist, load=load)
    (broken,) = Registry.discover([point]).broken
    assert "flyby-odd is broken: Odd: no exception" in str(broken)


def test_a_line_that_a_plugin_fails_at_is_named_with_the_plugin() -> None:
    def breaks(*_: object) -> Any:
        raise PluginFault("'GO a': the form 'motion' fails: KeyError", Span("a.odd", 3, 1, 0, 0))

    reader = SimpleNamespace(read=breaks, read_file=breaks)
    vendor = discovered(odd(reader=reader, suffixes=(".odd",))).find_vendor("odd")
    said = (
        r"^a\.odd:3:1: the plugin flyby-odd 1\.0 is at fault: the reader of odd: 'GO a': the form"
    )
    with pytest.raises(PluginFault, match=said):
        vendor.read("x", "a.odd")


@pytest.mark.parametrize("read", [fails, lambda *_: 3])
def test_what_reads_a_controllers_files_names_the_plugin(read: Any) -> None:
    vendor = discovered(odd(machine_data=read, described=read, stated=read)).find_vendor("odd")
    robot, file = find_robot("ur/ur5e"), Path("machine.dat")
    asked: dict[str, Callable[[], Any]] = {
        "machine_data": lambda: vendor.as_described(robot, file),
        "stated": lambda: vendor.as_stated(robot, file),
        "described": lambda: vendor.described and vendor.described(file),
    }
    for what, ask in asked.items():
        with pytest.raises(
            InputError, match=f"^the plugin flyby-odd 1.0 is at fault: {what} of odd"
        ):
            ask()
