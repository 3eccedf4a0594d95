"""The distribution of extensions under ``examples`` as a stranger's: installed, listed, used."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from flyby.core.errors import InputError
from flyby.core.hookspec import hookimpl
from flyby.core.plugins.loading import Offers, offers_of
from flyby.core.plugins.parts import Exporter, LogForm
from flyby.core.registry import installed
from flyby.core.vendor import lazy_robots

sys.path.insert(0, str(Path(__file__).parent))
import uninstalled

uninstalled.on_path("extensions")
globals().update(uninstalled.own_tests("extensions"))

JOB = """\
MODULE job
  PROC main()
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v200, fine, tool0;
    WaitTime 2.5;
    MoveAbsJ [[10,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v200, fine, tool0;
  ENDPROC
ENDMODULE
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of packages in which a distribution for each hook is installed, and a broken one."""
    folder = tmp_path_factory.mktemp("site")
    for name in ("robots", "logs", "exporter", "rules"):
        module = f"flyby_extensions.{name}"
        uninstalled.install(folder, f"flyby-{name}", {f"extensions-{name}": module})
    uninstalled.install(folder, "flyby-old", {"old": "flyby_old"})
    (folder / "flyby_old.py").write_text(
        "from flyby.core.hookspec import hookimpl\n"
        "@hookimpl\n"
        "def flyby_register_robots(register):\n"
        "    register.add('abb', {'x': print}, api=0)\n",
        "utf-8",
    )
    return folder


def flyby(site: Path, *words: object) -> subprocess.CompletedProcess[str]:
    source = uninstalled.EXAMPLES / "extensions" / "src"
    environment = {**os.environ, "PYTHONPATH": f"{site}{os.pathsep}{source}", "COLUMNS": "200"}
    code = "from flyby.cli.main import app; app()"
    command = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def test_what_is_installed_is_listed(site: Path) -> None:
    made = flyby(site, "vendors", "--json")
    found = {one["name"]: one for one in json.loads(made.stdout) if "adds" in one}
    assert {name: one["adds"] for name, one in found.items()} == {
        "abb/lab-6": "robot",
        "joint-trace": "reads logs",
        "playback": "exports",
        "extensions.long-wait": "rule",
        "extensions.slow-corner": "rule",
    }
    assert found["playback"]["distribution"] == "flyby-exporter 1.0"
    assert "built for version 0 of flyby's plugin interface" in made.stderr


def test_all_four_are_used(site: Path, tmp_path: Path) -> None:
    job, played = tmp_path / "job.mod", tmp_path / "job.playback"
    job.write_text(JOB, "utf-8")
    driven = flyby(site, "emulate", job, "--robot", "abb/lab-6", "--export", played)
    assert driven.returncode == 0, driven.stderr
    frames = played.read_text("utf-8").splitlines()
    assert frames[0] == "frame_ms A1 A2 A3 A4 A5 A6" and frames[-1].split()[1] == "10.0000"
    checked = flyby(site, "check", job, "--robot", "abb/lab-6", "--json")
    rules = [one["rule"] for one in json.loads(checked.stdout)["findings"]]
    assert "extensions.long-wait" in rules
    log = tmp_path / "run.txt"
    rows = [frame.replace(" ", ";") for frame in frames[1:]]
    log.write_text("\n".join(["#joint-trace", *rows, ""]), "utf-8")
    compared = flyby(site, "compare", job, log, "--robot", "abb/lab-6")
    assert compared.returncode == 0, compared.stderr


def refused(**hooks: Any) -> str:
    plugin = SimpleNamespace(**{name: hookimpl(hook) for name, hook in hooks.items()})
    with pytest.raises(InputError) as told:
        offers_of(plugin, "plugin", Offers(vendors=dict(installed().vendors)))
    return str(told.value)


def test_what_is_unsound_is_refused_by_name() -> None:
    from flyby_extensions import exporter, rules

    arm = lazy_robots([Path("irb1200-5-090.toml")])
    form = LogForm("Trace", "x", lambda path: False, lambda path, robot: None)
    spiky = Exporter("spiky", "x", ("sim",), lambda run: b"")

    def robots_of(vendor: str, robots: Any) -> Any:
        return lambda register: register.add(vendor, robots, api=1)

    named = "flyby_register_robots"
    assert "'acme', which is not installed" in refused(**{named: robots_of("acme", arm)})
    assert "abb/irb1200-5-090 is registered already" in refused(**{named: robots_of("abb", arm)})
    assert "needs a loader" in refused(**{named: robots_of("abb", {"x": 3})})
    assert "adds nothing" in refused(flyby_register_logs=lambda register: None)
    assert "lower-case" in refused(flyby_register_logs=lambda register: register.add(form))
    assert "takes a LogForm" in refused(flyby_register_logs=lambda register: register.add(spiky))
    assert "a tuple like" in refused(flyby_register_exporters=lambda register: register.add(spiky))
    other = Exporter("other", "x", (".other",), exporter.export)
    newer = refused(flyby_register_exporters=lambda register: register.add(other, api=7))
    assert "install a newer flyby" in newer

    def unnamed(register: Any) -> None:
        from dataclasses import replace

        waits = []
        rules.flyby_register_rules(
            SimpleNamespace(
                add_program_rule=lambda rule, api: waits.append(rule),
                add_run_rule=lambda rule, api: None,
            )
        )
        register.add_program_rule(replace(waits[0], id="long-wait"))

    assert "as acme.long-wait" in refused(flyby_register_rules=unnamed)
