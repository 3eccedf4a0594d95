"""Pages in a real browser: they load, the arm moves as the trajectory says, all is linked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flyby
from flyby.core.robot.assembly import assemble
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.tasks.pages.of_results import page_bytes
from flyby.tasks.results.runs import Run

ROOT = Path(__file__).parents[3]
CLOSE = 2e-4
"""m, between what the page draws and the trajectory."""
HOSTILE = "<img src=x onerror=alert(1)></script><script>alert(2)</script>"
Opened = Callable[..., Any]


@pytest.fixture(scope="module")
def run() -> Run:
    program = flyby.read(ROOT / "examples/pick.script", cell=ROOT / "examples/cell/pick.toml")
    return flyby.emulate(program)


@pytest.fixture(scope="module")
def page(run: Run) -> bytes:
    return page_bytes(run)


def drawn(view: Any, track: int = 0) -> np.ndarray[Any, Any]:
    """World matrices (F, 4, 4) of the frames of an arm as three.js has them, once drawn."""
    found = view.evaluate(
        """async (track) => {
          const frame = () => new Promise((done) => requestAnimationFrame(done));
          await frame();
          await frame();
          const arm = flyby.view.arms.find((one) => one.track.index === track);
          arm.group.updateMatrixWorld(true);
          return arm.nodes.map((node) => node.matrixWorld.elements);
        }""",
        track,
    )
    return np.array(found).reshape(-1, 4, 4).transpose(0, 2, 1)


def test_links_are_where_the_trajectory_has_them(opened: Opened, page: bytes, run: Run) -> None:
    view = opened(page)
    names = view.evaluate("flyby.session.arms[0].nodes.map((node) => node.name)")
    robot, trajectory = run.robot, run.trajectory
    rows = np.linspace(0, len(trajectory.t) - 1, 9).astype(int)
    moved = []
    for row in rows:
        view.evaluate("(t) => flyby.session.seek(t)", float(trajectory.t[row]))
        shown = drawn(view)
        for link in range(robot.arm_size + 1):
            chain = assemble([*robot.base_stages(), *robot.link_stages(link)])
            R, p = poses(chain, np.ascontiguousarray(trajectory.q[row : row + 1]))
            at = shown[names.index("base") + link]
            assert np.linalg.norm(at[:3, 3] - p[0]) < CLOSE
            assert np.abs(at[:3, :3] - R[0]).max() < 2e-4
        moved.append(shown[names.index("flange"), :3, 3])
    assert np.ptp(moved, axis=0).max() > 0.3, "the test must see the arm in other places"


def test_playback_moves_the_arm(opened: Opened, page: bytes) -> None:
    view = opened(page)
    before = drawn(view)
    view.keyboard.press("Space")
    view.wait_for_function("() => flyby.session.t > 0.3", timeout=60_000)
    view.keyboard.press("Space")
    after = drawn(view)
    assert view.evaluate("flyby.session.playing") is False
    assert np.linalg.norm(after[-1, :3, 3] - before[-1, :3, 3]) > 1e-3
    assert view.evaluate("flyby.view.drawn") > 1


def test_a_click_on_a_line_moves_the_clock_and_marks_the_rest(opened: Opened, page: bytes) -> None:
    view = opened(page)
    view.get_by_role("tab", name="Moves").click()
    line = view.locator(".line[data-line='19']")
    times = []
    for _ in range(3):
        line.click()
        move = view.evaluate(
            "flyby.session.track.moves[flyby.session.track.moveAt(flyby.session.t)]"
        )
        assert move["line"] == 19
        assert view.locator(".line.now").get_attribute("data-line") == "19"
        row = view.locator("tr.now td").first.inner_text()
        assert int(row) == move["number"]
        times.append(view.evaluate("flyby.session.t"))
        assert times[-1] == pytest.approx(move["begin"])
    assert times[0] < times[1], "the line is driven twice"
    assert times[2] == times[0], "then again from the first"


def test_a_click_on_a_row_and_on_a_plot_moves_the_clock(opened: Opened, page: bytes) -> None:
    view = opened(page)
    view.get_by_role("tab", name="Moves").click()
    view.locator("tbody tr").nth(6).click()
    assert view.evaluate("flyby.session.t") == pytest.approx(
        view.evaluate("flyby.session.track.moves[6].begin")
    )
    box = view.locator(".u-over").first.bounding_box()
    view.mouse.click(box["x"] + 0.75 * box["width"], box["y"] + 20)
    t, duration = view.evaluate("[flyby.session.t, flyby.session.duration]")
    assert t == pytest.approx(0.75 * duration, rel=0.01)


def test_a_click_on_the_path_goes_there(opened: Opened, page: bytes) -> None:
    """The clock, and with it the line of the source, the row of its move and the plots."""
    view = opened(page)
    view.get_by_role("tab", name="Moves").click()
    wanted = 0.4 * view.evaluate("flyby.session.duration")
    x, y = view.evaluate("(t) => flyby.view.onScreen(flyby.session.track.tcp(t))", wanted)
    box = view.locator(".scene").bounding_box()
    view.mouse.click(box["x"] + x, box["y"] + y)
    t = view.evaluate("flyby.session.t")
    near = view.evaluate("(t) => flyby.session.track.tcp(t)", t)
    meant = view.evaluate("(t) => flyby.session.track.tcp(t)", wanted)
    assert t > 0.0
    assert np.linalg.norm(np.subtract(near, meant)) < 0.05
    move = view.evaluate("(t) => flyby.session.track.moves[flyby.session.track.moveAt(t)]", t)
    # Where it waits, the wait's own line is what is driven.
    driven = view.evaluate("(t) => flyby.session.track.restAt(t)", t) or move
    now = view.locator(".line.now")
    assert now.get_attribute("data-line") == str(driven["line"]) != "0"
    assert view.locator("tr.now td").first.inner_text() == str(move["number"])
    for shown, room in ((now, ".code"), (view.locator("tr.now"), ".tables .scroll")):
        inside, outside = shown.bounding_box(), view.locator(room).first.bounding_box()
        assert inside["y"] + inside["height"] > outside["y"], "it is scrolled to"
        assert inside["y"] < outside["y"] + outside["height"], "it is scrolled to"
    assert view.locator(".clock").inner_text().startswith(f"{t:.3f}")
    plot = view.locator(".u-over").first.bounding_box()
    head = view.locator(".u-over .playhead").first.bounding_box()
    share = (head["x"] + 0.5 * head["width"] - plot["x"]) / plot["width"]
    duration = view.evaluate("flyby.session.duration")
    assert share == pytest.approx(t / duration, abs=0.01)


def test_arrows_lead_from_driven_line_to_driven_line(opened: Opened, page: bytes) -> None:
    view = opened(page)
    driven = view.locator(".line.drives").evaluate_all("(all) => all.map((e) => e.dataset.line)")
    view.locator(".code").focus()
    view.keyboard.press("Home")
    seen = []
    for _ in range(4):
        view.keyboard.press("ArrowDown")
        seen.append(view.locator(".line.picked").get_attribute("data-line"))
    first = driven.index(seen[0])
    assert seen == driven[first : first + 4]
    assert view.locator(".line.now").get_attribute("data-line") == seen[-1]
    view.keyboard.press("ArrowUp")
    assert view.locator(".line.picked").get_attribute("data-line") == seen[-2]


def test_all_that_works_is_reached_by_the_tab_key_and_has_a_name(
    opened: Opened, page: bytes
) -> None:
    view = opened(page)
    nameless = view.evaluate(
        """() => [...document.querySelectorAll("button, select, input, [tabindex='0']")]
          .filter((e) => !e.hidden && !(e.innerText || e.ariaLabel || e.title || e.labels?.length))
          .map((e) => e.outerHTML)"""
    )
    assert nameless == []
    reached = []
    for _ in range(60):
        view.keyboard.press("Tab")
        reached.append(view.evaluate("document.activeElement.closest('section')?.className"))
    order = [name for k, name in enumerate(reached) if name and name not in reached[:k]]
    assert order == ["top", "scene", "transport", "plots", "source", "tables"]


def test_playback_camera_and_zoom_by_keys_and_pointer(opened: Opened, page: bytes) -> None:
    view = opened(page)
    duration = view.evaluate("flyby.session.duration")
    view.get_by_label("time", exact=True).evaluate(
        "(e) => { e.value = 0.5 * e.max; e.dispatchEvent(new Event('input')); }"
    )
    assert view.evaluate("flyby.session.t") == pytest.approx(0.5 * duration)
    view.keyboard.press("+")
    assert view.evaluate("flyby.session.speed") == 2
    assert view.get_by_label("speed of playback").input_value() == "2"
    view.keyboard.press("l")
    view.keyboard.press("End")
    assert view.evaluate("[flyby.session.loop, flyby.session.t]") == [False, duration]
    # Without the loop it stands at the end.
    view.evaluate("flyby.session.seek(flyby.session.duration - 0.05)")
    view.keyboard.press("Space")
    view.wait_for_function("() => !flyby.session.playing", timeout=60_000)
    assert view.evaluate("flyby.session.t") == duration
    seen = []
    for key in "1234":
        view.keyboard.press(key)
        seen.append(tuple(view.evaluate("flyby.view.camera.position.toArray()")))
    assert len(set(seen)) == 4
    view.keyboard.press("f")
    view.keyboard.press("Home")
    drawn(view)
    target, tcp = view.evaluate(
        "[flyby.view.controls.target.toArray(), flyby.session.track.tcp(0)]"
    )
    assert target == pytest.approx(tcp, abs=1e-6)
    box = view.locator(".u-over").first.bounding_box()
    y = box["y"] + 20
    view.mouse.move(box["x"] + 0.25 * box["width"], y)
    view.mouse.down()
    view.mouse.move(box["x"] + 0.75 * box["width"], y, steps=4)
    view.mouse.up()
    assert view.evaluate("flyby.session.view") == pytest.approx(
        [0.25 * duration, 0.75 * duration], rel=0.02
    )
    view.keyboard.press("z")
    assert view.evaluate("flyby.session.view") is None


def test_tables_are_sorted_and_filtered(opened: Opened, page: bytes) -> None:
    view = opened(page)
    view.get_by_role("tab", name="Moves").click()
    heading = view.locator("th", has_text="time")
    heading.get_by_role("button").click()
    heading.get_by_role("button").click()
    times = view.locator("tbody tr td:nth-child(6)").all_inner_texts()
    values = [float(text) for text in times if text]
    assert values == sorted(values, reverse=True)
    view.locator("input[type=search]").fill("movej")
    kinds = view.locator("tbody tr td:nth-child(2)").all_inner_texts()
    assert kinds and set(kinds) == {"MoveJ"}


def test_the_clearance_is_drawn_between_its_pair(opened: Opened, page: bytes, run: Run) -> None:
    view = opened(page)
    least = run.report.to_cell
    assert least is not None
    found = view.evaluate(
        """() => { const { t, distance } = flyby.session.track.data.clearance;
        const k = distance.indexOf(Math.min(...Array.from(distance).filter(Number.isFinite)));
        flyby.session.seek(t[k]); return [distance[k], flyby.session.track.clearanceAt(t[k])]; }"""
    )
    distance, near = found
    assert distance == pytest.approx(least.distance, abs=2e-3)
    gap = np.linalg.norm(np.subtract(near["first"], near["second"]))
    assert gap == pytest.approx(abs(near["distance"]), abs=1e-4)


def test_hostile_names_are_text(opened: Opened, tmp_path: Path) -> None:
    source = (ROOT / "examples/square.mod").read_text("utf-8")
    source = source.replace("MODULE Square", f"MODULE Square ! {HOSTILE}")
    path = tmp_path / "a&b<i>.mod"
    path.write_text(source, "utf-8")
    program = flyby.read(path, robot="abb/irb6640-180-255")
    view = opened(page_bytes(flyby.emulate(program)))
    assert HOSTILE in view.locator(".line").first.inner_text()
    assert view.locator("img:not(.printed)").count() == 0
    assert view.locator("body script:not([type])").count() == 1
    assert "a&b<i>.mod" in view.locator(".source .bar").inner_text()


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("size", [(1280, 720), (820, 1180)])
def test_nothing_is_outside_of_the_window(
    opened: Opened, page: bytes, theme: str, size: tuple[int, int]
) -> None:
    view = opened(page, color_scheme=theme, viewport={"width": size[0], "height": size[1]})
    assert view.evaluate("document.documentElement.dataset.theme") == theme
    assert view.evaluate("document.documentElement.scrollWidth") <= size[0]
    assert view.evaluate("flyby.view.renderer.domElement.clientWidth") > 0.5 * size[0]


def test_it_runs_in_the_frame_of_a_notebook(browser: Any, page: bytes, tmp_path: Path) -> None:
    from flyby.drawing.page.html import page_frame

    path = tmp_path / "notebook.html"
    path.write_text(f"<meta charset=utf-8>{page_frame(page)}", "utf-8")
    context = browser.new_context(offline=True)
    view = context.new_page()
    wrong: list[str] = []
    view.on("pageerror", lambda error: wrong.append(str(error)))
    view.goto(path.resolve().as_uri())
    frame = view.frames[1]
    frame.evaluate("flyby.ready.then(() => true)")
    assert frame.evaluate("flyby.session.tracks.length") == 1
    context.close()
    assert not wrong
