"""``flyby vendors``, ``flyby robots``, and what all commands share."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import version

import pytest
from typer.testing import Result

from flyby.core import registry as registry_module
from flyby.core.registry import BrokenPlugin, Registry, find_robot, vendors
from flyby.tasks import catalogue

Flyby = Callable[..., Result]


@pytest.fixture
def broken_plugin(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    whole = registry_module.installed()
    broken = BrokenPlugin("acme", "flyby-acme", ImportError("no module named 'acme'"))
    monkeypatch.setattr(registry_module, "installed", lambda: Registry(whole.vendors, (broken,)))
    catalogue.registry.cache_clear()
    yield
    catalogue.registry.cache_clear()


def test_vendors_lists_what_is_registered(flyby: Flyby) -> None:
    listed = json.loads(flyby("vendors", "--json").stdout)
    assert [entry["vendor"] for entry in listed] == [vendor.name for vendor in vendors()]
    abb = next(entry for entry in listed if entry["vendor"] == "abb")
    assert ".mod" in abb["suffixes"]
    assert {"read", "write"} <= set(abb["language"])
    table = flyby("vendors").stdout
    assert all(vendor.name in table for vendor in vendors())


def test_robots_lists_every_robot(flyby: Flyby) -> None:
    names = [entry["robot"] for entry in json.loads(flyby("robots", "--json").stdout)]
    known = [f"{vendor.name}/{robot}" for vendor in vendors() for robot in sorted(vendor.robots)]
    assert names == known
    table = flyby("robots").stdout
    assert all(name in table for name in known)


def test_robots_of_one_vendor(flyby: Flyby) -> None:
    names = [entry["robot"] for entry in json.loads(flyby("robots", "abb", "--json").stdout)]
    assert names
    assert all(name.startswith("abb/") for name in names)


def test_a_robot_in_detail_states_limits_and_origins(flyby: Flyby) -> None:
    robot = find_robot("abb/irb6640-180-255")
    shown = flyby("robots", robot.name).stdout
    assert "payload 180 kg" in shown
    for joint in robot.joints:
        assert joint.name in shown
    for group, origin in robot.origins.items():
        assert group in shown
        assert origin.split(":")[0] in shown
    data = json.loads(flyby("robots", robot.name, "--json").stdout)
    assert [joint["velocity"] for joint in data["joints"]] == list(robot.limits.velocity)
    assert data["origins"] == dict(robot.origins)


def test_emulation_only_robots_say_why(flyby: Flyby) -> None:
    kuka = next(vendor for vendor in vendors() if vendor.name == "kuka")
    name, reason = next(iter(kuka.emulation_only.items()))
    assert f"Emulation only: {reason}"[:60] in flyby("robots", f"kuka/{name}").stdout


@pytest.mark.parametrize("command", [("vendors",), ("robots",), ("robots", "abb")])
def test_a_broken_plugin_is_a_warning(
    flyby: Flyby, broken_plugin: None, command: tuple[str, ...]
) -> None:
    result = flyby(*command)
    assert result.exit_code == 0
    assert "warning: plugin 'acme' of flyby-acme is broken: ImportError" in result.stderr
    assert "abb" in result.stdout


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("robots", "abb/irb664-180-255"), "near it are abb/irb6640-180-255 (180 kg, 2.55 m)"),
        (("robots", "IRB 6640-999"), "abb/irb6640-130-320 (130 kg, 3.2 m)"),
        (("robots", "KR 6 R901"), "near it are kuka/kr6-r900-2 (6 kg, 0.9 m)"),
        (("robots", "abbb"), "unknown robot 'abbb': those of abb, kuka, ur are known"),
        (("robots", "abbb"), "'flyby robots' lists all"),
        (("robots", "KR 180-2"), "near it are kuka/kr180-2-pa (180 kg, 3.2 m)"),
    ],
)
def test_unknown_names_come_with_an_offer(
    flyby: Flyby, words: tuple[str, ...], message: str
) -> None:
    result = flyby(*words)
    assert result.exit_code == 1
    assert message in result.stderr


@pytest.mark.parametrize("words", [("emulate",), ("fk", "--bogus"), ("nothing",)])
def test_usage_errors_have_their_own_status(flyby: Flyby, words: tuple[str, ...]) -> None:
    assert flyby(*words).exit_code == 2


def test_version(flyby: Flyby) -> None:
    assert flyby("--version").stdout == f"flyby {version('flyby')}\n"


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys\n"
        "from flyby.cli.main import app\n"
        "try:\n    app(['--help'], prog_name='flyby')\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'numba', 'matplotlib', 'pinocchio', 'trimesh', 'yourdfpy'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_emulating_imports_matplotlib_only_for_plots() -> None:
    code = (
        "import sys\n"
        "import flyby.cli.emulate, flyby.tasks.results.runs, flyby.cli.output.report_text\n"
        "import flyby.core.motion.emulator.controller\n"
        "print(sorted({'matplotlib', 'trimesh', 'yourdfpy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_an_interruption_is_no_traceback(flyby: Flyby, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Registry, "find_robot", interrupted)
    result = flyby("robots", "abb/irb6640-180-255")
    assert result.exit_code == 130
    assert "Traceback" not in result.output
