"""`import flyby`: what it exports, what it loads, and that both doors take and refuse the same."""

from __future__ import annotations

import inspect
import math
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import pytest
from typer.testing import CliRunner

import flyby
from flyby.cli.main import app
from flyby.core.door import command_line
from flyby.core.errors import InputError
from flyby.core.notebook import table
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.problems.improve.solution import FigureRow
from flyby.tasks.optimize import OptimizeOptions
from flyby.tasks.options.entries import TaskOptions, entries, flag
from flyby.tasks.options.shell import SHELL
from flyby.tasks.painting.options import PaintOptions
from flyby.tasks.pareto import ParetoOptions
from flyby.tasks.setup import RobotOptions, named_robot

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
SQUARE = ROOT / "examples/square.mod"
Small = Callable[..., Path]


def all_options(kind: type[TaskOptions] = TaskOptions) -> list[type[TaskOptions]]:
    for name in flyby.__all__:
        getattr(flyby, name)
    return [kind, *(deep for one in kind.__subclasses__() for deep in all_options(one))]


def test_every_name_is_there_and_tells_of_itself() -> None:
    for name in flyby.__all__:
        found = getattr(flyby, name)
        assert callable(found) and inspect.getdoc(found), name
    assert set(flyby.__all__) <= set(dir(flyby))
    with pytest.raises(AttributeError, match="no attribute 'emulat'"):
        _ = flyby.emulat


def test_importing_loads_nothing_heavy() -> None:
    code = (
        "import sys, flyby\n"
        "heavy = {'numpy', 'scipy', 'numba', 'matplotlib', 'pinocchio', 'cvxpy', 'typer', 'rich'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


MOVES = {
    "abb/irb6640-180-255": "MoveAbsJ [[#,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;",
    "kuka/kr30-3": "PTP {A1 #,A2 -90,A3 90,A4 0,A5 0,A6 0}",
    "ur/ur10e": "movej([0.#,0,0,0,0,0], a=1, v=1)",
}
FILES = {
    "abb/irb6640-180-255": (".mod", "MODULE NAME\nPROC NAME()\nMOVE\nENDPROC\nENDMODULE\n"),
    "kuka/kr30-3": (".src", "DEF NAME()\nMOVE\nEND\n"),
    "ur/ur10e": (".script", "def NAME():\nMOVE\nend\n"),
}


@pytest.mark.parametrize("robot", FILES)
def test_a_folder_whose_program_cannot_be_parsed_drives_no_other(
    tmp_path: Path, robot: str
) -> None:
    suffix, whole = FILES[robot]

    def put(name: str, move: str) -> None:
        text = whole.replace("NAME", name).replace("MOVE", move.replace("#", "5"))
        (tmp_path / f"{name}{suffix}").write_text(text, "utf-8")

    put("main", MOVES[robot] + " )")
    put("other", MOVES[robot])
    for entry in (None, "main"):
        with pytest.raises(InputError, match=rf"not read: .*main{re.escape(suffix)}:\d+:\d+: "):
            flyby.read(tmp_path, robot=robot, entry=entry)
    assert len(flyby.read(tmp_path, robot=robot, entry="other").moves) == 1
    put("main", MOVES[robot])
    put("other", MOVES[robot] + " )")
    assert len(flyby.read(tmp_path, robot=robot).moves) == 1


def test_a_program_is_read_from_a_file_a_folder_and_a_text(tmp_path: Path) -> None:
    text = SQUARE.read_text("utf-8")
    (tmp_path / "square.mod").write_text(text, "utf-8")
    (tmp_path / "notes.txt").write_text("not a program", "utf-8")
    read = [flyby.read(source, robot=ROBOT) for source in (SQUARE, tmp_path, text)]
    assert read[0] == read[1] == read[2] and len(read[0].moves) > 1


@pytest.mark.parametrize(("robot", "beside"), [("ur/ur5e", "a.txt"), ("kuka/kr30-3", "sps.sub")])
def test_what_stands_beside_a_program_is_none(robot: str, beside: str, tmp_path: Path) -> None:
    texts = {
        "ur/ur5e": ("main.script", "movej([0,-1.5,1.5,0,0.5,0])\nmovej([1,-1.5,1.5,0,0.5,0])\n"),
        "kuka/kr30-3": ("main.src", "DEF main( )\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nEND\n"),
    }
    (tmp_path / beside).write_text("DEF sps( )\nEND\n", "utf-8")
    name, text = texts[robot]
    (tmp_path / name).write_text(text, "utf-8")
    assert flyby.read(tmp_path, robot=robot).moves


def test_a_run_tells_of_its_moves() -> None:
    run = flyby.emulate(flyby.read(SQUARE, robot=ROBOT))
    spent = sum(m.time + m.wait + m.settling for m in run.moves) + run.report.first_wait
    assert spent == pytest.approx(run.duration)
    assert run.moves[3].limited_by in {limit.name for limit in run.moves[3].limits}
    assert run.trajectory.q.shape[1] == 6
    assert len(repr(run).splitlines()) == 1 and "<svg" in run._repr_html_()


def test_what_is_written_is_read_back_as_the_same_program(tmp_path: Path) -> None:
    program = flyby.read(SQUARE, robot=ROBOT)
    (file,) = flyby.write(program, tmp_path / "new")
    again = flyby.read(file, robot=ROBOT)
    assert flyby.emulate(again).duration == pytest.approx(flyby.emulate(program).duration)
    with pytest.raises(InputError, match="force=True replaces it") as refused:
        flyby.write(program, tmp_path / "new")
    assert str(refused.value).startswith(f"out {file}: exists already")


def test_a_patch_changes_the_numbers_alone(tmp_path: Path) -> None:
    program = flyby.read(SQUARE, robot=ROBOT)
    slower = [replace(m, speed=replace(m.speed, tcp=0.1, name=None)) for m in program.moves]
    changed = program.with_moves(tuple(slower))
    (file,) = flyby.patch(changed, out=tmp_path)
    old, new = SQUARE.read_text("utf-8"), file.read_text("utf-8")
    assert old != new
    assert flyby.read(file, robot=ROBOT).moves[1].speed.tcp == pytest.approx(0.1)
    with pytest.raises(InputError, match="in_place=True"):
        flyby.patch(changed)


def test_a_cell_is_held_against_what_was_read() -> None:
    program = flyby.read(SQUARE, robot="abb/irb1600-6-145")
    with pytest.raises(InputError, match="which robot"):
        flyby.emulate(replace(program, setup=None))


@pytest.mark.parametrize("kind", all_options(), ids=lambda kind: kind.__name__)
def test_every_option_has_a_flag_of_its_own_and_is_explained(kind: type[TaskOptions]) -> None:
    flags = [flag(kind, name) for name in entries(kind)]
    assert len(set(flags)) == len(flags)
    assert all(entry.help for entry in entries(kind).values())


REFUSED = [
    (OptimizeOptions, {"tilt": 4.0}, ("--tilt", "230"), "tilt 4: rad from 0 to 3.14159"),
    (OptimizeOptions, {"starts": 0}, ("--starts", "0"), "starts 0: a number from 1 on"),
    (OptimizeOptions, {"clearance": -0.001}, ("--clearance", "-1"), "a distance in m, zero"),
    (OptimizeOptions, {"vias": "some"}, ("--vias", "some"), "vias some: keep or change"),
    (OptimizeOptions, {"objective": 2.0}, ("--objective", "2"), "a weight between 0 and 1"),
    (
        OptimizeOptions,
        {"zones_only": True, "tilt": 0.1},
        ("--zones-only", "--tilt", "5"),
        "do not go with it",
    ),
    (ParetoOptions, {"points": 1}, ("--points", "1"), "points 1: a number from 2 on"),
    (ParetoOptions, {"change": "all"}, ("--change", "all"), "waypoints, zones or speeds"),
]
COMMANDS = {OptimizeOptions: "optimize", ParetoOptions: "pareto"}


@pytest.mark.parametrize("kind, options, words, said", REFUSED)
def test_both_doors_refuse_the_same(
    kind: type[TaskOptions], options: dict[str, object], words: tuple[str, ...], said: str
) -> None:
    with pytest.raises(InputError) as refused:
        kind(**options)
    assert said in str(refused.value)
    typed = CliRunner().invoke(app, [COMMANDS[kind], str(SQUARE), "--robot", ROBOT, *words])
    assert typed.exit_code == 2
    with command_line(SHELL), pytest.raises(InputError) as refused:
        kind(**options)

    def without_numbers(text: str) -> str:
        return re.sub(r"[-\d.]+", "#", " ".join(text.split()))

    assert without_numbers(f"error: {refused.value}") == without_numbers(typed.stderr)


@pytest.mark.parametrize("name", ["facing", "sweep", "deviation", "zone", "points"])
@pytest.mark.parametrize("wrong", [-1.0, float("nan"), "far"])
def test_numbers_are_checked_when_options_are_made(name: str, wrong: object) -> None:
    with pytest.raises(InputError, match=rf"^{name} "):
        PaintOptions(target=5e-5, **{name: wrong})  # type: ignore[arg-type]


def test_options_name_no_robot_twice() -> None:
    assert RobotOptions(robot=ROBOT).robot == ROBOT
    other, cell = ROBOT.replace("180", "235"), two_joints()
    with pytest.raises(InputError) as refused:
        flyby.read(SQUARE, robot=other, cell=cell)
    message = str(refused.value)
    assert message.startswith(f"robot={other}: the cell {cell} is one of {ROBOT}; leave the robot")


def test_no_task_drives_another_vendors_robot_with_a_program() -> None:
    with pytest.raises(InputError) as of_reading:
        flyby.read(SQUARE, robot="ur/ur10e")
    program = flyby.read(SQUARE, robot=ROBOT)
    for task in (flyby.emulate, flyby.check):
        with pytest.raises(InputError) as refused:
            task(program, robot="ur/ur10e")
        assert str(refused.value) == str(of_reading.value)
        assert "is a program for abb, the robot is driven by ur" in str(refused.value)
    built = replace(program, reading=None, setup=None)
    assert flyby.emulate(built, robot=ROBOT).duration > 0


def two_joints() -> str:
    return str(ROOT / "examples/cell/two_joints.toml")


def test_a_free_motion_needs_no_program() -> None:
    ends = "0,0,0,0,30,0", "20,10,0,0,30,0"
    found = flyby.free_motion(*ends, robot=ROBOT, no_floor=True, intervals=10, trials=0)
    assert found.proven and 0.0 < found.duration <= found.optimum.first.duration
    assert found.trajectory.q[-1, 1] == pytest.approx(math.radians(10), abs=1e-6)


def test_tuning_a_path_is_no_slower_than_the_program() -> None:
    found = flyby.tune(flyby.read(SQUARE, robot=ROBOT))
    assert found.duration <= found.before * (1 + 1e-6)
    assert sum(share for _, share in found.limits()) == pytest.approx(1.0)


@pytest.mark.parametrize("task", [flyby.emulate, flyby.check, flyby.optimize, flyby.tune])
def test_a_task_says_that_it_takes_programs(task: Callable[..., object]) -> None:
    with pytest.raises(InputError, match=r"expected a program, not str: flyby\.read\(path"):
        task("two_joints.mod")


def test_only_what_has_files_is_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected a program or what .*, not Path|not PosixPath"):
        flyby.write(tmp_path, tmp_path / "out")  # type: ignore[arg-type]
    assert not (tmp_path / "out").exists()


def test_a_misspelt_option_is_named_with_what_was_meant() -> None:
    with pytest.raises(TypeError, match=r"flyby\.read has no option 'robt'; did you mean robot\?"):
        flyby.read("a.mod", robt="abb/irb6640-180-255")  # type: ignore[call-arg]


def test_names_are_listed_once() -> None:
    assert dir(flyby) == sorted(set(dir(flyby)))


@pytest.mark.parametrize(
    "given, taken",
    [
        ({"keep": 99}, (99,)),
        ({"keep": "v100"}, ("v100",)),
        ({"keep": [1, "v100"]}, (1, "v100")),
        ({"free": "all"}, ("all",)),
        ({"limit": "all=fixed"}, ("all=fixed",)),
        ({"axes": 2}, (2,)),
        ({"others": "a.mod"}, ("a.mod",)),
        ({"parameters": "time.smoothing_s[*]"}, ("time.smoothing_s[*]",)),
        ({"at": [0.0] * 6}, ([0.0] * 6,)),
        ({"vias": ("0,0,0,0,0,0", [0.1] * 6)}, ("0,0,0,0,0,0", [0.1] * 6)),
        ({"angles": 0.5}, (0.5,)),
    ],
)
def test_one_value_is_a_list_of_one(given: dict[str, object], taken: tuple[object, ...]) -> None:
    (name,) = given
    kinds = (kind for kind in all_options() if name in entries(kind))
    kind = next(kind for kind in kinds if not entries(kind)[name].choices)
    found = getattr(kind(**given), name)
    assert list(map(_plain, found)) == list(map(_plain, taken))


def _plain(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value


def test_no_list_takes_what_is_none() -> None:
    lists = 0
    for kind in all_options():
        for name, entry in entries(kind).items():
            if entry.several:
                lists += 1
                for wrong in (object(), [1.5j], [object()], True):
                    with pytest.raises(InputError, match=f"^{name} is .*, not "):
                        kind(**{name: wrong})
    assert lists > 10


@pytest.mark.parametrize(
    "task, said",
    [
        (lambda: flyby.read(5, robot=ROBOT), "source is text or a path, not 5"),
        (lambda: flyby.read(SQUARE, robot=5), "robot is text or Robot, not 5"),
        (lambda: flyby.read(SQUARE), r"flyby\.robots\(\) lists them"),
        (lambda: flyby.read(SQUARE, robot="ur/ur5e"), r'flyby\.robots\("abb"\) lists them'),
        (lambda: flyby.free_motion(5, 5, robot=ROBOT), "start is text or a list, not 5"),
        (lambda: flyby.robot(5), "name is text, not 5"),
        (lambda: flyby.patch(None, out="x"), "expected a program, not NoneType"),
    ],
)
def test_wrong_types_are_refused_by_name(task: Callable[[], object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        task()


def test_a_missing_argument_says_of_which_task() -> None:
    with pytest.raises(TypeError, match=r"flyby\.translate: missing .*'robot'"):
        flyby.translate(flyby.read(SQUARE, robot=ROBOT))  # type: ignore[call-arg]


def test_messages_of_the_core_name_options_as_the_door_does() -> None:
    text = SQUARE.read_text("utf-8").replace("MoveJ p1", "MoveJ p_elsewhere", 1)
    assert "answer it in a file (answers)" in flyby.read(text, robot=ROBOT).moves[1].open
    with command_line(SHELL):
        assert "answer it in a file (--io)" in flyby.read(text, robot=ROBOT).moves[1].open


def test_remedies_of_findings_name_options_as_the_door_does() -> None:
    program = flyby.read(SQUARE.with_name("deburring.mod"), robot=ROBOT)
    assert any(f.fix.endswith("answer what is open by answers") for f in flyby.check(program))
    with command_line(SHELL):
        assert any(f.fix.endswith("answer what is open by --io") for f in flyby.check(program))


def test_helps_state_units_as_the_door_takes_them() -> None:
    assert "From signal to paint, s. Default: 0.0" in str(flyby.paint.__doc__)
    assert "Thickness wanted, with its unit: 50um. As numbers: m." in str(flyby.paint.__doc__)
    with command_line(SHELL):
        assert entries(PaintOptions)["delay"].explained == "From signal to paint, ms."
    for kind in all_options():
        for name, entry in entries(kind).items():
            assert (entry.scale.factor != 1.0) == ("{unit}" in entry.help), name


def test_values_show_themselves_in_a_line() -> None:
    program = flyby.read(SQUARE, robot=ROBOT)
    run = flyby.emulate(program)
    made = flyby.translate(program, robot="kuka/kr30-3")
    cell = flyby.cell(two_joints())
    path, made_of = run.path, (run.trajectory, run.timing, run.report, run.moves, run.moves[3])
    motions = [named_robot(name) for name in flyby.robots()]
    models = [one.vendor.motion_of(one.robot) for one in motions]
    moves = [*program.moves, *made.program.moves, program.setup, *motions, *models]
    for shown in (program, run, path, path.route, *made_of, made, cell, cell.robot, *moves):
        line = repr(shown)
        assert len(line) <= 120 and "\n" not in line and line[0] + line[-1] == "<>", line
    for page in (program, made, cell, cell.robot):
        assert all(part in page._repr_html_() for part in ("<svg", "<table>", repr(page)[1:-1]))
    assert "notes" in repr(replace(program, notes=())) and "0 notes" not in repr(program)


def test_moves_setups_and_motion_models_tell_what_matters() -> None:
    program = flyby.read(ROOT / "examples/deburring.mod", robot=ROBOT)
    assert repr(program.moves[0]) == "<MoveJ to jHome, v1000, fine, tool0, wobj0, line 83>"
    assert " 310.0, 95.5, 232.3 mm, v1500, z40, tGripper, wobjConv, " in repr(program.moves[2])
    assert repr(program.moves[17]).startswith("<MoveC through pC25 to pC30, vDeburr, zCorner, ")
    picking = flyby.read(ROOT / "examples/pick.script", robot="ur/ur5e").moves[1]
    assert repr(picking) == (
        "<MoveJ to -450.0, -250.0, 270.0 mm, 60.16°/s, 30 mm, tcp, wobj0, line 14>"
    )
    assert repr(MoveJ(JointTarget((0.5, -1.0)), Speed(duration=2.0))) == (
        "<MoveJ to joints 0.5, -1, in 2 s, fine, tool0, wobj0>"
    )
    assert repr(MoveL(program.moves[2].target, Speed(tcp=0.3))).count(", 300 mm/s, fine") == 1
    assert "% of the joints' speed" in repr(MoveJ(JointTarget((0.0,)), Speed(joint_fraction=0.3)))
    assert repr(program.setup) == f"<Setup: {ROBOT}, driven by abb, no cell>"
    stood = flyby.read(ROOT / "examples/cell/two_joints.mod", cell=two_joints()).setup
    assert repr(stood) == f"<Setup: {ROBOT}, driven by abb, cell two_joints.toml>"
    model = named_robot("kuka/kr30-3").vendor.motion_of(flyby.robot("kuka/kr30-3"))
    stated = len(model.figures)
    line = f"<Motion model: period 12 ms, zones half, smoothing 36 + 36 ms, {stated} figures: "
    assert repr(model).startswith(line)
    counts = [int(n) for n in re.findall(r"(\d+) (?:assumed|fitted|published)", repr(model))]
    assert sum(counts) == stated


def test_a_source_that_holds_no_program_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "notes.txt").write_text("nothing", "utf-8")
    with pytest.raises(InputError, match=r"is a folder without a program of kuka"):
        flyby.read(tmp_path, robot="kuka/kr30-3")
    (tmp_path / "square.mod").write_text(SQUARE.read_text("utf-8"), "utf-8")
    monkeypatch.chdir(tmp_path)  # an empty path is this folder
    with pytest.raises(InputError, match="source is empty"):
        flyby.read("", robot=ROBOT)


def test_options_of_files_are_those_of_write() -> None:
    program = flyby.read(SQUARE, robot=ROBOT)
    with pytest.raises(TypeError, match=r"no option 'out'; flyby\.write\(result, folder\)"):
        flyby.record(program, out="new")  # type: ignore[call-arg]


def test_logs_that_are_not_there_are_told_so(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="which logs"):
        flyby.identify([], robot=ROBOT)
    with pytest.raises(InputError, match=r"absent\.mod: there is no such file or folder"):
        flyby.identify(tmp_path / "absent.mod", robot=ROBOT)


def test_an_answer_that_nothing_asks_for_is_noted(tmp_path: Path) -> None:
    file = tmp_path / "answers.toml"
    file.write_text('[values]\ndi_prat = 1\n[passes]\n"square.mod:1" = 2\n', "utf-8")
    (note,) = flyby.read(SQUARE, robot=ROBOT, answers=file).notes
    asked = "did not ask for di_prat in [values], square.mod:1 in [passes]"
    assert str(note).endswith(asked) and str(note).startswith(str(file))


def test_short_cells_of_a_notebook_are_not_broken() -> None:
    page = table((("limited by", "left"),), [("J2 torque (100 %)",), ("a sentence " * 9,)])
    assert 'white-space:nowrap">J2 torque (100 %)<' in page and page.count("nowrap") == 1


def test_a_figure_that_is_not_known_is_empty() -> None:
    assert FigureRow("cycle time", "s", None, 1.60547).shown == ("", "1.6055")


def test_what_a_result_was_made_of_is_not_written_over(tmp_path: Path) -> None:
    class Made:
        inputs = (tmp_path / "motion.toml",)
        files = MappingProxyType({"motion.toml": b"new"})

    Made.inputs[0].write_bytes(b"old")
    with pytest.raises(InputError, match="would overwrite"):
        flyby.write(Made(), tmp_path, force=True)
    assert Made.inputs[0].read_bytes() == b"old"
