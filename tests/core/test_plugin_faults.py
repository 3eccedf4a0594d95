"""What fails of one plugin is named as its fault, and hinders no other."""

from __future__ import annotations

import logging
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from flyby.core.errors import InputError
from flyby.core.hookspec import hookimpl
from flyby.core.registry import Registry
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
