"""Pages of every kind in a real browser: they load, and show what is theirs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import flyby
from flyby.core.errors import InputError
from flyby.core.spatial.pose import Pose
from flyby.tasks.pages.of_results import BUILDERS, page_bytes, page_of
from flyby.tasks.pages.station_page import station_page

from ...cli.box_program import CELL, module

ROOT = Path(__file__).parents[3]
ROBOT = "abb/irb6640-180-255"
SQUARE = ROOT / "examples/square.mod"
Opened = Callable[..., Any]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def changed(folder: Path) -> bytes:
    (folder / "cell.toml").write_text(CELL, "utf-8")
    source = folder / "box.mod"
    moves = [f"MoveAbsJ p{k},v1000,z10,rod;" for k in (1, 2, 3)]
    source.write_text(module(*moves), "utf-8", newline="")
    return page_bytes(flyby.zones(flyby.read(source, cell=folder / "cell.toml")))


def test_before_and_after(opened: Opened, changed: bytes) -> None:
    view = opened(changed)
    assert view.evaluate("flyby.view.arms.map((arm) => arm.ghost)") == [False, True]
    # Ghosts come before all that is solid, so that these hide them.
    orders = view.evaluate(_ORDERS)
    assert max(orders["true"]) < min(orders["false"])
    assert view.evaluate("flyby.session.track.name") == "after"
    assert view.locator(".proof").inner_text().startswith("✓ proven")
    view.locator(".proof").click()
    at, told = view.evaluate("[flyby.session.t, flyby.session.track.data.proof.t]")
    assert at == pytest.approx(told)
    assert view.evaluate("flyby.view.tightest.visible")
    view.locator(".choice").get_by_role("button", name="before").click()
    assert view.evaluate("flyby.session.track.name") == "before"
    assert "z10" in view.locator(".source").inner_text()


@pytest.mark.parametrize("wide", [1280, 1024, 820])
def test_all_at_the_top_is_inside_and_apart(opened: Opened, changed: bytes, wide: int) -> None:
    view = opened(changed, viewport={"width": wide, "height": 768})
    boxes = view.evaluate(
        """() => [...document.querySelectorAll(".top > *, .fact, .choice > *")]
          .filter((e) => !e.hidden).map((e) => [e.className, e.getBoundingClientRect().toJSON()])"""
    )
    assert {"title", "facts", "shares", "choice", "tools"} <= {name for name, _ in boxes}
    assert all(box["left"] >= 0 and box["right"] <= wide for _, box in boxes)
    areas = [box for name, box in boxes if name in ("title", "facts", "shares", "choice", "tools")]
    for k, one in enumerate(areas):
        for other in areas[k + 1 :]:
            apart = one["right"] <= other["left"] or other["right"] <= one["left"]
            assert apart or one["bottom"] <= other["top"] or other["bottom"] <= one["top"]


def test_paper_is_light_and_holds_all_tables(opened: Opened, changed: bytes) -> None:
    view = opened(changed, color_scheme="dark")
    titles = view.evaluate("flyby.tables.tables.map((table) => table.title)")
    view.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert view.evaluate("document.documentElement.dataset.theme") == "light"
    assert view.locator(".papers h2").evaluate_all("(all) => all.map((e) => e.innerText)") == titles
    assert view.locator(".printed").get_attribute("src").startswith("data:image/png")
    view.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert view.evaluate("document.documentElement.dataset.theme") == "dark"
    assert view.locator(".papers table").count() == 0


def test_what_is_driven_fills_its_plot_and_names_fit(opened: Opened) -> None:
    """Programs ask for vmax; a UR's joints have long names."""
    moves = "".join(f"movel(p[0.4,{y},0.4,0,3.14,0], a=9, v=50)\n" for y in (-0.2, 0.2))
    run = flyby.emulate(flyby.read(f"def main():\n{moves}end\n", robot="ur/ur5e"))
    view = opened(page_bytes(run))
    top = view.evaluate("flyby.plots.slots[0].made.scales.y.max")
    driven = "flyby.plots.slots[0].curves[0].channel.values"
    most = view.evaluate(f"Array.from({driven}).reduce((a, b) => Math.max(a, b))")
    assert 0.0 < most <= top < 1.5 * most < 50e3
    cut = """() => [...document.querySelectorAll(".read span")]
      .filter((name) => name.scrollWidth > name.clientWidth + 1).map((name) => name.textContent)"""
    assert view.locator(".read").nth(1).inner_text().count("wrist") == 3
    assert view.evaluate(cut) == []


def test_waypoint_by_waypoint(opened: Opened, changed: bytes) -> None:
    """Both begin each move together, although one of them is faster."""
    view = opened(changed)
    view.get_by_label("how tracks run together").select_option("waypoints")
    for move in (2, 3, 4):
        assert_begun_together(view, move, move)


def assert_begun_together(view: Any, ghosts: int, solids: int) -> None:
    """When the solid arm begins a move of its own, the ghost does one of its."""
    times = view.evaluate(
        """([ghosts, solids]) => {
          const [ghost, solid] = flyby.session.tracks;
          flyby.session.seek(solid.moves[solids].begin);
          return [flyby.session.timeOf(ghost), ghost.moves[ghosts].begin];
        }""",
        [ghosts, solids],
    )
    assert times[0] == pytest.approx(times[1], abs=2e-3)


_ORDERS = """() => {
  const found = { true: [], false: [] };
  for (const arm of flyby.view.arms) {
    arm.group.traverse((object) => {
      if (object.userData.solid && object.userData.body.role === "link") {
        found[arm.ghost].push(object.renderOrder);
      }
    });
  }
  return found;
}"""


def test_paint(opened: Opened, folder: Path) -> None:
    x, y = np.meshgrid(np.linspace(-150, 150, 6), np.linspace(-100, 100, 4))
    vertices = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    index = np.arange(24).reshape(4, 6)
    a, b, c, d = (
        i.ravel() for i in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    )
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    trimesh.Trimesh(vertices, faces, process=False).export(folder / "panel.stl")
    (folder / "bell.toml").write_text(
        "reference_distance_mm = 250\nnear_radius_mm = 35\n"
        "radius_mm = [0, 150, 250]\ngrowth_um_s = [2, 20, 0]\n"
    )
    painted = flyby.paint(
        folder / "panel.stl", folder / "bell.toml", target="50um", units="mm", points=100
    )
    page = page_of(painted)
    assert page.coat is not None
    known = page.coat.thickness.values[np.isfinite(page.coat.thickness.values)]
    assert known.mean() == pytest.approx(list(painted.coats.values())[-1].thickness.mean())
    # There is no robot, and no text of a program.
    assert [chart.title for chart in page.charts] == ["TCP speed"]
    view = opened(page_bytes(painted))
    assert not view.locator(".source").is_visible() and view.locator(".tables").is_visible()
    assert view.evaluate("flyby.view.coat.mesh.geometry.attributes.color.count") > 100
    assert "of them within ±10 %" in view.locator(".drawing").inner_text()
    # The coat builds up: at each time kept it is what the gun has laid until then.
    growth = page.coat.growth
    assert growth is not None
    laid = np.cumsum(growth.laid.values, axis=1) * growth.step
    np.testing.assert_allclose(laid[:, -1], known, atol=0.51 * growth.step + 0.02e-6)
    times, motion = growth.times.values, painted.painting.best
    for k in (len(times) // 3, 2 * len(times) // 3):
        begun = np.clip((times[k] - motion.times[:-1]) / motion.duration, 0.0, 1.0)
        rates = painted.painting.judge.deposition.rates(motion)
        wanted = rates @ (motion.duration * begun)
        np.testing.assert_allclose(laid[:, k - 1], wanted, atol=0.6 * growth.step)
        view.evaluate("(t) => { flyby.session.seek(t + 2e-3); flyby.view.pose(); }", times[k])
        drawn = view.evaluate("flyby.view.coat.thickness()")
        np.testing.assert_allclose(drawn, laid[:, k - 1], atol=1e-9)
        assert view.evaluate("flyby.view.coat.cone.visible") == view.evaluate(
            "flyby.view.coat.sprays(flyby.session.t)"
        )
    view.evaluate("(t) => { flyby.session.seek(t); flyby.view.pose(); }", 0.0)
    assert not any(view.evaluate("flyby.view.coat.thickness()"))
    # The gun's tip is where it was planned.
    best = painted.painting.best
    middle = 0.5 * best.total_duration
    meant = [np.interp(middle, best.times, column) for column in best.position.T]
    assert np.linalg.norm(
        np.subtract(view.evaluate("(t) => flyby.session.track.tcp(t)", middle), meant)
    ) == pytest.approx(0.0, abs=2e-4)


def test_a_fence_does_not_hide_the_robot(opened: Opened) -> None:
    run = flyby.emulate(
        flyby.read(
            ROOT / "examples/kuka_archive",
            entry="PRESS",
            cell=ROOT / "examples/cell/press.toml",
        )
    )
    view = opened(page_bytes(run))
    opacity = """(place) => {
      const { camera } = flyby.view;
      camera.position.set(...place);
      flyby.view.touch();
      flyby.view.render();
      const fence = flyby.view.veils.bodies.find(({ mesh }) => mesh.userData.body.name === "fence");
      return fence.mesh.material.opacity;
    }"""
    before, behind = view.evaluate(opacity, [0.5, -6.0, 1.0]), view.evaluate(opacity, [0.5, 6.0, 1])
    assert before < 0.15 < 0.4 < behind
    assert "fence" in view.evaluate("flyby.overlay.named.map((one) => one.text)")


def test_tabs_of_many_tables_are_all_seen(opened: Opened, changed: bytes) -> None:
    for width in (1280, 1024):
        view = opened(changed, viewport={"width": width, "height": 720})
        cut = """() => [...document.querySelectorAll(".tabs button")].filter((tab) => {
          const { left, right } = tab.getBoundingClientRect();
          const room = tab.parentElement.getBoundingClientRect();
          return left < room.left - 1 || right > room.right + 1;
        }).map((tab) => tab.textContent)"""
        assert view.locator(".tabs button").count() > 4 and view.evaluate(cut) == []


def test_a_station_runs_on_one_clock(opened: Opened) -> None:
    made = flyby.station(ROOT / "examples/two_robots/station.toml")
    view = opened(page_bytes(made))
    assert view.evaluate("flyby.view.arms.map((arm) => arm.ghost)") == [False, False]
    assert view.evaluate("flyby.session.duration") == pytest.approx(made.duration, abs=2e-3)
    schedules = made.run.schedules
    # Who ends last is seen first; bar and tables are those of who is chosen.
    assert made.bottleneck == view.evaluate("flyby.session.track.name") == "right"
    assert "waits for others 2.6" in view.locator(".shares").inner_text()
    view.locator(".tabs").get_by_text("Lines").click()
    assert view.locator("tbody td").first.inner_text() == "11"
    view.locator(".choice").get_by_role("button", name="left").click()
    assert "waits for others" not in view.locator(".shares").inner_text()
    assert view.locator(".tabs [aria-selected=true]").inner_text() == "Lines"
    assert view.evaluate("flyby.tables.tables.map((table) => table.track ?? 0)").count(1) == 0
    # Both stand where their schedules say, while the one waits and when it goes on.
    for t in (1.0, 2.5, 4.0, 6.5):
        for k, (name, member) in enumerate(made.station.members.items()):
            own = np.clip(schedules[name].own(np.array([t])), 0.0, member.run.duration)
            path = member.run.trajectory
            q = [np.interp(own[0], path.t, column) for column in path.q.T]
            drawn = view.evaluate("([k, t]) => flyby.session.tracks[k].joints(t)", [k, t])
            np.testing.assert_allclose(drawn, q, atol=3e-4)
    (pair,) = made.clearances
    curve = "flyby.session.tracks[0].channel('between')"
    least = view.evaluate(f"flyby.session.tracks[0].value({curve}, {pair.least_at})")
    assert least == pytest.approx(1e3 * pair.least, abs=10.0)
    # The space that both sweep is drawn where it is asked for.
    assert view.evaluate("flyby.view.swept") is None
    view.locator(".menu summary").click()
    view.get_by_label("swept space").check()
    counts = view.evaluate("flyby.view.swept.map((one) => one.children.map((c) => c.count))")
    assert len(counts) == 2 and all(set(own) == {24} for own in counts)
    view.get_by_label("swept space").uncheck()
    assert view.evaluate("flyby.view.swept.map((one) => one.visible)") == [False, False]
    view.locator(".menu summary").click()
    # A click on a bar goes to its time, its robot and its line; both sources are there.
    (spell,) = schedules["right"].waits
    x, y = view.evaluate("(t) => [flyby.plots.placeOf(t), 2 + 15 * 1.5]", 1.0)
    view.locator(".band canvas").click(position={"x": x, "y": y})
    assert view.evaluate("flyby.session.t") == pytest.approx(1.0, abs=0.02)
    assert view.evaluate("flyby.session.track.name") == "right"
    picked = view.locator(".line.picked").first
    assert picked.get_attribute("data-line") == str(spell.action.span.line)
    shown = view.locator(".source .bar").all_inner_texts()
    assert [text.split(":")[0] for text in shown] == ["right", "left"]
    assert view.locator(".line.now").first.get_attribute("data-line") == str(spell.action.span.line)


def test_a_station_with_better_programs(opened: Opened) -> None:
    """Robots as they drive now; what changed in each, and how they drove before, on one clock."""
    made = flyby.station_zones(ROOT / "examples/two_robots/station.toml")
    view = opened(page_bytes(made))
    top = view.locator(".top").inner_text()
    assert f"{made.before.duration:.3f} → {made.after.duration:.3f} s" in top
    rows = view.evaluate("flyby.plots.gantt.rows.map((row) => row.name)")
    assert {"left", "right", "left, before", "right, before"} <= set(rows)
    whole = made.before.duration
    assert view.evaluate("flyby.session.duration") == pytest.approx(whole, abs=2e-3)
    assert f"{made.after.duration:.3f} s" in view.locator(".choice").inner_text()
    view.locator(".choice").get_by_role("button", name="left").click()
    view.locator(".tabs").get_by_text("Changes").click()
    changed = [one for one in made.solutions["left"].zones if one.before != one.after]
    assert view.locator("tbody tr").count() == len(changed) > 0
    view.locator("tbody tr").first.click()
    line = view.locator(".line.picked").inner_text()
    assert "Move" in line and "z" in line


def test_no_column_of_the_causes_is_cut(opened: Opened) -> None:
    program = flyby.read(ROOT / "examples/pick.script", cell=ROOT / "examples/cell/pick.toml")
    view = opened(page_bytes(flyby.emulate(program)))
    assert view.locator("th").last.inner_text() == "line"
    room = "[flyby.tables.body.scrollWidth, flyby.tables.body.clientWidth]"
    wide, has = view.evaluate(room)
    assert wide <= has
    # A wait takes its time at its own line, not at that of the move before it.
    costs = view.locator(".line:has-text('sleep(0.3)') .cost, .line:has-text('movel(spot') .cost")
    assert costs.all_inner_texts()[1] == "2 × 0.30"


def test_of_two_states_the_routine_that_differs_is_seen(opened: Opened, folder: Path) -> None:
    text = SQUARE.read_text("utf-8")
    begin, end = text.index("PROC main()"), text.index("ENDMODULE")
    second = text[begin:end].replace("main", "Again")
    for name, speed in {"old": "v500", "new": "v300"}.items():
        made = text[:end] + second.replace("v500", speed) + text[end:]
        (folder / f"{name}.mod").write_text(made, "utf-8")
    found = flyby.diff(folder / "old.mod", folder / "new.mod", robot=ROBOT)
    view = opened(page_bytes(found))
    shown = view.evaluate("[flyby.session.track.group, flyby.session.track.name]")
    assert shown == ["Again", "after"]
    titles = view.evaluate("flyby.tables.tables.map((table) => table.title)")
    assert titles == ["Routines", "Differences", "Files", "Causes", "Lines", "Moves"]


def test_the_path_of_a_translated_program_is_where_its_robot_drives(opened: Opened) -> None:
    """The new robot stands elsewhere, and what it drives is drawn in the old one's world."""
    program = flyby.read(ROOT / "examples/seam.src", robot="kuka/kr30-3")
    place = Pose((0.4, 0.0, 0.6))
    made = flyby.translate(program, robot="ur/ur10e", base=place)
    view = opened(page_bytes(made, place=place))
    for share in (0.2, 0.5, 0.8):
        t, found = view.evaluate(
            """(share) => {
              const { session, view } = flyby;
              const t = share * session.track.duration;
              const path = view.paths.find((one) => !one.ghost);
              return [t, path.pick(...view.onScreen(session.track.tcp(t)), 3)?.t];
            }""",
            share,
        )
        assert found == pytest.approx(t, abs=0.05)


def test_two_states_run_waypoint_by_waypoint(opened: Opened, folder: Path) -> None:
    """Also where one of them has a move that the other has not, and drives slower."""
    text = SQUARE.read_text("utf-8")
    (folder / "short.mod").write_text(text, "utf-8")
    line = "MoveL Offs(p1,200,200,0), v500"
    more = text.replace(line, f"MoveL Offs(p1,200,100,30), v200, z1, tool0;\n    {line}")
    assert more != text
    (folder / "longer.mod").write_text(more, "utf-8")
    view = opened(page_bytes(flyby.diff(folder / "short.mod", folder / "longer.mod", robot=ROBOT)))
    clock = view.evaluate("flyby.session.tracks.map((track) => flyby.session.timeOf(track, 1.0))")
    assert clock == [1.0, 1.0]
    view.get_by_label("how tracks run together").select_option("waypoints")
    counts = view.evaluate("flyby.session.tracks.map((track) => track.moves.length)")
    assert counts == [7, 8]
    for move in range(1, 7):
        assert_begun_together(view, move, move if move < 3 else move + 1)


def test_a_station_that_never_ends_says_so(opened: Opened, folder: Path) -> None:
    for name in ("left", "right"):
        for suffix in (".toml", ".mod"):
            text = (ROOT / f"examples/two_robots/{name}{suffix}").read_text("utf-8")
            (folder / f"{name}{suffix}").write_text(
                text.replace("SetDO doLeft, 1;", "SetDO doLeft, 0;"), "utf-8"
            )
    text = (ROOT / "examples/two_robots/station.toml").read_text("utf-8")
    (folder / "station.toml").write_text(text, "utf-8")
    made = flyby.station(folder / "station.toml", no_proof=True)
    assert made.deadlock is not None
    view = opened(page_bytes(made))
    assert "never ends" in view.locator(".top").inner_text()
    assert view.locator(".notices li").count() == len(made.findings())
    # Right waits for ever where it began, and is shown no further than that.
    page = station_page(made)
    right = page.tracks[1]
    assert right.duration <= page.tracks[0].duration * 1.05 + 1e-9
    assert [move.end for move in right.moves[1:]] == [None] * (len(right.moves) - 1)


def test_a_log_beside_its_emulation(opened: Opened, folder: Path) -> None:
    """Curves of the measured track are drawn beside an emulated one that has none of them."""
    program = flyby.read(SQUARE, robot=ROBOT)
    moved = flyby.emulate(program).trajectory
    t = np.arange(0.0, moved.t[-1], 0.008)
    q = np.column_stack([np.interp(t, moved.t, column) for column in moved.q.T])
    rows = np.column_stack([1.03 * t, q])
    path = folder / "log.csv"
    np.savetxt(path, rows, "%.9g", ",", header="t,q1,q2,q3,q4,q5,q6", comments="")
    found = flyby.compare(program, log=path)
    share, _, words = found.longer.partition(" ")
    assert float(share) == pytest.approx(3.0, abs=0.5) and words == "% longer than"
    view = opened(page_bytes(found))
    assert f"{found.longer} emulated" in view.locator(".top").inner_text()
    assert view.evaluate("flyby.plots.slots.map((slot) => slot.curves.length)")[0] == 1
    view.locator(".choice").get_by_role("button", name="measured").click()
    assert view.evaluate("flyby.session.track.name") == "measured"
    # The buttons say the times that the page says above, and both speeds are in one plot.
    aligned = found.prediction.alignment
    for name, time in (("emulated", aligned.moving), ("measured", aligned.logged_moving)):
        assert view.locator(".choice").get_by_role("button", name=f"{name} {time:.3f} s").count()
        assert f"{time:.3f} s" in view.locator(".facts").inner_text()
    names = view.evaluate("flyby.plots.slots[1].curves.map((curve) => curve.name)")
    assert "TCP" in names and "driven, emulated" in names
    values = view.evaluate("Array.from(flyby.session.track.channel('speed').values)")
    assert max(values) == pytest.approx(1000.0 / 1.03, rel=0.01)


def test_points_of_a_front_are_picked(opened: Opened) -> None:
    program = flyby.read(SQUARE, robot=ROBOT)
    view = opened(page_bytes(flyby.pareto(program, points=2)))
    dots = view.locator(".drawing circle")
    count = view.evaluate("flyby.session.tracks.length")
    assert dots.count() == count >= 2
    dots.nth(count - 1).click(force=True)
    assert view.evaluate("flyby.session.active") == count - 1
    view.locator(".drawing circle.given").press("Enter")
    assert view.evaluate("flyby.session.track.name") == "given"


def test_findings_lead_to_their_lines(opened: Opened) -> None:
    program = flyby.read(ROOT / "examples/pick.script", cell=ROOT / "examples/cell/pick.toml")
    view = opened(page_bytes(flyby.check(program), program=program))
    view.locator("tbody tr", has_text="between bottle 1 and bottle 2").first.click()
    assert view.locator(".line.picked").get_attribute("data-line") == "18"
    assert view.evaluate("flyby.session.t") > 0.0


def test_findings_alone_make_a_page(opened: Opened) -> None:
    program = flyby.read(SQUARE, robot=ROBOT)
    view = opened(page_bytes(flyby.check(program)))
    assert view.locator("table").count() == 1


def test_other_results_have_no_page() -> None:
    with pytest.raises(InputError, match="there is no page of int; there are of"):
        page_bytes(3)
    assert {"Run", "Solution", "Findings", "PaintedPart"} <= set(BUILDERS)


def test_a_page_is_written_and_shown(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = flyby.emulate(flyby.read(SQUARE, robot=ROBOT))
    path = flyby.report(run, folder / "run.html")
    assert path.read_bytes().startswith(b"<!doctype html>")
    with pytest.raises(InputError, match="must end in"):
        flyby.report(run, folder / "run.txt")
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
    run.show()
    assert flyby.show(run).as_uri() == opened[-1]
    shown = run._repr_html_()
    assert shown.startswith("<iframe sandbox=") and "<svg" in shown
