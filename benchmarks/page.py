"""Pages, measured: how large they are, how quickly they are made, how smoothly they play.

Cases: a program of so many moves round a table, on an IRB 6640 with a tool and things round it as
meshes. ``page`` and ``compressed`` are the file's size as it is and as mail servers pack it,
``sample`` the bytes that one sample of the controller takes with all joints, ``make`` and
``emulate`` CPU seconds of the page and of the run that it shows.

``frames`` are those that headless Chromium draws in a second of playback at 1280 × 720, in
software (SwiftShader), with the bodies that the case counts; as other work slows that,
``frames_cpu`` are those in a second of the CPU time of all its processes; ``seek`` is how long it
takes to put all of the arm where it is at another time, without drawing. Needs Playwright and
Chromium.
"""

from __future__ import annotations

import gzip
import math
import os
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import report
import trimesh

import flyby
from flyby.drawing.page.html import page_html
from flyby.drawing.page.packing import Packer
from flyby.tasks.pages.run_page import run_page

ROBOT = "abb/irb6640-180-255"
CASES = {"moves-100": 100, "moves-1000": 1000}
WARM, FRAMES = 20, 100
"""Frames that are drawn before any counts, and that count."""
_PLAYED = """async (frames) => {
  flyby.session.play(true);
  const [first, begin] = [flyby.view.drawn, performance.now()];
  while (flyby.view.drawn - first < frames) await new Promise(requestAnimationFrame);
  return (performance.now() - begin) / 1000;
}"""
FLAGS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_HOME = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def module(moves: int) -> str:
    """A program that goes round and round a table, each time at other heights."""
    lines = [
        "MODULE Rounds",
        "  PERS tooldata gun:=[TRUE,[[0,0,250],[1,0,0,0]],[4,[0,0,100],[1,0,0,0],0,0,0]];",
        "  PROC main()",
        "    ConfL\\Off;",
        "    ConfJ\\Off;",
        f"    MoveAbsJ [[0,0,0,0,90,0],{_HOME}],v1000,fine,gun;",
    ]
    for k in range(moves - 1):
        angle = 2 * math.pi * k / 9
        x, y = 1500 + 250 * math.cos(angle), 350 * math.sin(angle)
        z = 1000 + 120 * math.sin(0.37 * k)
        zone = "fine" if k % 12 == 11 else f"z{(10, 20, 50)[k % 3]}"
        lines.append(
            f"    MoveL [[{x:.2f},{y:.2f},{z:.2f}],[0,0,1,0],[0,0,0,0],{_HOME}],"
            f"v{(500, 800, 1000)[k % 3]},{zone},gun;"
        )
        if k % 12 == 11:
            lines.append("    WaitTime 0.2;")
    return "\n".join([*lines, "  ENDPROC", "ENDMODULE", ""])


def cell(folder: Path) -> Path:
    """A tool, a fixture and a fence as meshes of some ten thousand triangles each."""
    made = {
        "gun": trimesh.creation.annulus(0.02, 0.05, 0.2, sections=60).subdivide_to_size(0.006),
        "fixture": trimesh.creation.icosphere(subdivisions=5, radius=0.25),
        "fence": trimesh.creation.box((0.05, 3.0, 1.2)).subdivide_to_size(0.05),
    }
    for name, mesh in made.items():
        mesh.export(folder / f"{name}.stl")
    text = f"""robot = "{ROBOT}"
[tool.gun]
tcp = {{ xyz_mm = [0, 0, 250] }}
mesh = "gun.stl"
units = "m"
pose = {{ xyz_mm = [0, 0, 100] }}
"""
    places = {"fixture": [1500, 0, 450], "fence": [2600, 0, 600]}
    for name, place in places.items():
        text += (
            f'[[obstacle]]\nname = "{name}"\nmesh = "{name}.stl"\nunits = "m"\n'
            f"pose = {{ xyz_mm = {place} }}\n"
        )
    for k in range(8):
        text += (
            f'[[obstacle]]\nname = "post {k}"\nbox_mm = [80, 80, 900]\n'
            f"pose = {{ xyz_mm = [{-600 - 200 * k}, 1600, 450] }}\n"
        )
    path = folder / "cell.toml"
    path.write_text(text, "utf-8")
    return path


def measure(name: str) -> Iterator[report.Figure]:
    """The figures of a case."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        source = folder / "rounds.mod"
        source.write_text(module(CASES[name]), "utf-8")
        program = flyby.read(source, cell=cell(folder))
        run, emulated = _timed(lambda: flyby.emulate(program))
        page, made = _timed(lambda: run_page(run))
        file = page_html(page)
        packer = Packer()
        packer.json(page.tracks[0].motion)
        sample = len(packer.arrays()) / len(run.trajectory.t)
        bodies = len(page.arms[0].bodies)
        yield report.Figure(name, "page", len(file) / 1e6, "MB")
        yield report.Figure(name, "compressed", len(gzip.compress(file)) / 1e6, "MB")
        yield report.Figure(name, "sample", sample, "bytes")
        yield report.Figure(name, "emulate", emulated, "s")
        yield report.Figure(name, "make", made, "s")
        yield report.Figure(name, "bodies", float(bodies), "")
        yield from _in_browser(name, folder, file)


def _timed(call: Callable[[], Any]) -> tuple[Any, float]:
    start = time.process_time()
    found = call()
    return found, time.process_time() - start


def _in_browser(name: str, folder: Path, file: bytes) -> Iterable[report.Figure]:
    from playwright.sync_api import sync_playwright

    path = folder / "page.html"
    path.write_bytes(file)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
        view = browser.new_context(offline=True, viewport={"width": 1280, "height": 720}).new_page()
        start = time.perf_counter()
        view.goto(path.as_uri())
        view.evaluate("flyby.ready.then(() => new Promise(requestAnimationFrame))")
        loaded = time.perf_counter() - start
        view.evaluate(_PLAYED, WARM)
        spent = _cpu_seconds()
        seconds = view.evaluate(_PLAYED, FRAMES)
        spent = _cpu_seconds() - spent
        seek = view.evaluate(
            """() => {
              flyby.session.play(false);
              const begin = performance.now();
              for (let k = 0; k < 300; k += 1) {
                flyby.session.t = (k / 300) * flyby.session.duration;
                flyby.view.pose();
              }
              return (performance.now() - begin) / 300;
            }"""
        )
        browser.close()
    return (
        report.Figure(name, "loaded", loaded, "s"),
        report.Figure(name, "frames", FRAMES / seconds, "1/s"),
        report.Figure(name, "frames_cpu", FRAMES / spent, "1/s"),
        report.Figure(name, "seek", seek, "ms"),
    )


def _cpu_seconds() -> float:
    """CPU time so far of all processes that this one has started, and they."""
    parents: dict[int, int] = {}
    ticks: dict[int, int] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it has ended
        parents[int(stat.parent.name)] = int(fields[1])
        ticks[int(stat.parent.name)] = int(fields[11]) + int(fields[12])
    own = {os.getpid()}
    while more := {pid for pid, parent in parents.items() if parent in own} - own:
        own |= more
    return sum(ticks[pid] for pid in own - {os.getpid()}) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    report.main(__doc__, measure, CASES)
