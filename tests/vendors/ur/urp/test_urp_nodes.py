"""Each kind of node, as PolyScope writes it into scripts."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from flyby.core.program.move import MoveC, Wait
from flyby.core.program.program import Program
from flyby.core.program.target import PoseTarget
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.vendors.ur.run.reader import read_file
from flyby.vendors.ur.urp.source import source_of_text

from ..conftest import HOME, Build, listed

A, B, C = (0.1, -1.4, 1.6, -1.8, -1.5, 0.2), (0.3, -1.2, 1.5, -1.9, -1.6, 0.1), HOME
VARIABLE = '<Waypoint type="Variable" name="Variable"><variable name="{}"/></Waypoint>'


def script(build: Build, *steps: str, **how: object) -> list[str]:
    """Statements of the body, without markers, data of waypoints and indents.

    What a ``Move`` states for all of its waypoints stands in the place of its variables.
    """
    source, _ = source_of_text(build.program(*steps, **how), "job.urp")  # type: ignore[arg-type]
    shared = dict(re.findall(r"global (Move\w_\d+_[avr])=(.*)", source.text))
    text = re.sub(r"\bMove\w_\d+_[avr]\b", lambda found: shared[found[0]], source.text)
    lines = [line.strip() for line in text.split("\n")[2:-2]]
    said = r"\$ |global \w+_[pq]=|set_tcp|global [\d.]+="
    return [one for one in lines if not re.match(said, one)]


def told(build: Build, *steps: str) -> list[str]:
    _, notes = source_of_text(build.program(*steps), "job.urp")
    return [note.message for note in notes if "not at hand" not in note.message]


def opened(build: Build, folder: Path, *steps: str, parts: str = "", **how: object) -> Program:
    build.packed(folder / "default.installation", build.installation(parts))
    path = build.packed(folder / "job.urp", build.program(*steps, **how))  # type: ignore[arg-type]
    return read_file(path, ReadOptions(answers=Answers(goes_on=True)))


def names(program: Program) -> list[str | None]:
    return [move.target.name for move in program.moves]


def test_moves_are_written_as_by_polyscope(build: Build) -> None:
    assert script(
        build, build.move(build.fixed("W 1", A), build.fixed("W_2", B, 'blendRadius="0.02"'))
    ) == [
        "movej(get_inverse_kin(W_1_p, qnear=W_1_q), a=1.4, v=1.05)",
        "movej(get_inverse_kin(W_2_p, qnear=W_2_q), a=1.4, v=1.05, r=0.02)",
    ]
    own = 'cartesianSpeed="0.5" cartesianAcceleration="0.7" blendRadius="0.01"'
    assert script(build, build.move(build.fixed("W", A, own), kind="MoveL")) == [
        "movel(W_p, a=0.7, v=0.5, r=0.01)"
    ]
    timed = build.move(build.fixed("W", A, 'nextMotionTime="2.5"'))
    assert script(build, timed) == ["movej(get_inverse_kin(W_p, qnear=W_q), t=2.5)"]
    angles = build.move(build.fixed("W", A), attributes='positionType="JointAngles"')
    assert script(build, angles) == ["movej(W_q, a=1.4, v=1.05)"]
    process = build.move(
        build.fixed("A", A), build.fixed("B", B), kind="MoveP", attributes='blendRadius="0.025"'
    )
    assert script(build, process) == [
        "movep(A_p, a=1.4, v=1.05, r=0.025)",
        "movep(B_p, a=1.4, v=1.05, r=0.0)",
    ]


def test_waypoints_of_one_name_and_other_places_stay_two(build: Build, tmp_path: Path) -> None:
    step = build.move(build.fixed("W", A), build.fixed("W", B), build.fixed("W", A))
    program = opened(build, tmp_path, step)
    assert names(program) == ["W_p", "W_2_p", "W_p"]


def test_variables_stand_in_their_feature(build: Build) -> None:
    tool = '<feature class="GeomFeatureReference" referencedName="Joint_6_name"/>'
    assert script(build, build.move(VARIABLE.format("v"), kind="MoveL")) == [
        "movel(v, a=1.4, v=1.05)"
    ]
    assert script(build, build.move(VARIABLE.format("v"), kind="MoveL", feature=tool)) == [
        "movel(pose_trans(get_target_tcp_pose(), v), a=1.4, v=1.05)"
    ]


def test_a_relative_waypoint_goes_as_far_as_was_taught(build: Build, tmp_path: Path) -> None:
    ends = build.fixed("", B, tag="from"), build.fixed("", C, tag="to")
    relative = f'<Waypoint type="Relative" name="R">{"".join(ends)}</Waypoint>'
    both = build.move(build.fixed("B", B), build.fixed("C", C), kind="MoveL")
    program = opened(build, tmp_path, both, build.move(build.fixed("A", A), relative, kind="MoveL"))
    places = [m.target.pose.position for m in program.moves if isinstance(m.target, PoseTarget)]
    b, c, a, r = (list(place) for place in places)
    assert [z - x for z, x in zip(r, a, strict=True)] == pytest.approx(
        [z - x for z, x in zip(c, b, strict=True)], abs=1e-9
    )


def test_a_circle_goes_through_its_via_point(build: Build, tmp_path: Path) -> None:
    inside = f"<via>{build.fixed('V', B)}</via><to>{build.fixed('E', C)}</to>"
    circle = f'<CircleMove orientationMode="FIXED">{inside}</CircleMove>'
    other = (
        f"<CircleMove><children>{build.fixed('V', B)}{build.fixed('E', C)}</children></CircleMove>"
    )
    for node in (circle, other):
        step = build.move(build.fixed("A", A), node, kind="MoveP", attributes='blendRadius="0.01"')
        program = opened(build, tmp_path, step)
        assert isinstance(program.moves[1], MoveC)
    assert script(build, build.move(circle, kind="MoveP"))[-1].endswith("mode=1)")


def test_the_safe_home_is_the_installations(build: Build, tmp_path: Path) -> None:
    home = f'<SafeHomeSettings enabled="true" position="{listed(HOME)}"/>'
    node = build.node("SafeHome", speed="1.0", acceleration="1.4")
    (move,) = opened(build, tmp_path, node, parts=home).moves
    assert move.target.joints == HOME  # type: ignore[union-attr]
    assert script(build, node) == ["movej(safe_home_position, a=1.4, v=1.0)"]


def test_a_direction_is_driven_over_its_distance(build: Build, tmp_path: Path) -> None:
    def direction(until: str) -> str:
        tag = "gui.program.direction.MoveDirectionNode"
        return f"<{tag}>{build.expression('[0,0,2]')}<children>{until}</children></{tag}>"

    known = direction('<Until type="DISTANCE" distance="0.05"/>')
    program = opened(build, tmp_path, build.move(build.fixed("A", A), known, kind="MoveL"))
    first, second = (
        m.target.pose.position for m in program.moves if isinstance(m.target, PoseTarget)
    )
    assert [z - x for z, x in zip(second, first, strict=True)] == pytest.approx([0, 0, 0.05])
    open_end = direction('<Until type="TOOL_CONTACT_DETECTION"/>')
    (note,) = told(build, build.move(build.fixed("A", A), open_end, kind="MoveL"))
    assert "until tool contact detection only the robot knows" in note


@pytest.mark.parametrize(
    ("selected", "way"), [("XPlus", (1, 0, 0)), ("YMinus", (0, -1, 0)), ("ZPlus", (0, 0, 1))]
)
def test_a_direction_along_an_axis(
    build: Build, tmp_path: Path, selected: str, way: tuple[int, int, int]
) -> None:
    """As PolyScope 5 stores what is picked from its list, and the distance."""
    tag = "gui.program.direction.MoveDirectionNode"

    def along(until: str) -> str:
        return f'<{tag} selectedDirection="{selected}"><children>{until}</children></{tag}>'

    until = (
        '<Until type="DISTANCE" allowActions="false" deceleration="3.0" distanceNodeType="STOP">'
        '<Distance>0.03</Distance><motionParameters blendRadius="0.0"/></Until>'
    )
    program = opened(build, tmp_path, build.move(build.fixed("A", A), along(until), kind="MoveL"))
    first, second = (
        m.target.pose.position for m in program.moves if isinstance(m.target, PoseTarget)
    )
    moved = [z - x for z, x in zip(second, first, strict=True)]
    assert moved == pytest.approx([0.03 * share for share in way], abs=1e-12)
    open_end = along('<Until type="NONE" allowActions="false"/>')
    (note,) = told(build, build.move(build.fixed("A", A), open_end, kind="MoveL"))
    assert "until it is stopped only the robot knows" in note


def test_loops(build: Build, tmp_path: Path) -> None:
    def loop(kind: str, inside: str = "") -> str:
        return build.node(
            "Loop", build.move(build.fixed("A", A), build.fixed("B", B)), inside=inside, type=kind
        )

    counting = loop(
        "Counting", '<variable name="n"><initializeExpression/></variable><count>3</count>'
    )
    assert len(opened(build, tmp_path, counting).moves) == 6
    steps = (
        build.assignment("i", "0"),
        build.node(
            "Loop",
            build.move(build.fixed("A", A), build.fixed("B", B)),
            build.assignment("i", "i+1"),
            inside=build.expression("i≤1"),
            type="While",
        ),
    )
    assert len(opened(build, tmp_path, *steps).moves) == 4
    assert len(opened(build, tmp_path, loop("Forever")).moves) == 2
    (note,) = told(build, loop("Counting"))
    assert "how often it is passed is not stored" in note


@pytest.mark.parametrize(("value", "name"), [("1", "A_p"), ("2", "B_p"), ("3", "C_p")])
def test_branches(build: Build, tmp_path: Path, value: str, name: str) -> None:
    def branch(kind: str, text: str, waypoint: str) -> str:
        inside = build.expression(text) if text else "<expression/>"
        return build.node("If", waypoint, inside=inside, type=kind)

    moves = [build.move(build.fixed(one, q)) for one, q in (("A", A), ("B", B), ("C", C))]
    off = '<SuppressedNode><suppressedNode class="If" type="ElseIf"/></SuppressedNode>'
    ifs = (
        branch("If", "x≟1", moves[0]),
        off,
        branch("ElseIf", "x==2", moves[1]),
        branch("Else", "", moves[2]),
    )
    assert names(opened(build, tmp_path, build.assignment("x", value), *ifs)) == [name]
    cases = (
        build.node("SwitchCase", moves[0], value="1"),
        build.node("SwitchCase", moves[1], value="2"),
        build.node("DefaultCase", moves[2]),
    )
    switch = build.node("Switch", *cases, inside=build.expression("x"))
    assert names(opened(build, tmp_path, build.assignment("x", value), switch)) == [name]


def test_signals_and_waits(build: Build) -> None:
    def node(tag: str, kind: str, inside: str) -> str:
        return build.node(tag, inside=inside, type=kind)

    pin = '<pin referencedName="{}"/>'
    steps = (
        node(
            "Set", "DigitalOutput", pin.format("digital_out[3]") + "<digitalValue>1</digitalValue>"
        ),
        node(
            "Set", "DigitalOutput", pin.format("config_out[0]") + "<digitalValue>0</digitalValue>"
        ),
        node("Set", "AnalogOutput", pin.format("analog_out[1]") + "<analogValue>0.5</analogValue>"),
        node("Wait", "Sleep", "<waitTime>0.25</waitTime>"),
        node("Wait", "DigitalInput", pin.format("tool_in[1]") + "<digitalValue>0</digitalValue>"),
        node(
            "Wait",
            "AnalogInput",
            pin.format("analog_in[2]")
            + "<analogComparison>0</analogComparison><analogValue>4</analogValue>",
        ),
        node("Wait", "Condition", build.expression("ready == True")),
    )
    assert script(build, *steps) == [
        "set_standard_digital_out(3, True)",
        "set_configurable_digital_out(0, False)",
        "set_standard_analog_out(1, 0.5)",
        "sleep(0.25)",
        "while (not (get_tool_digital_in(1) == False)):",
        "sync()",
        "end",
        "while (not (get_tool_analog_in(0) < 4.0)):",
        "sync()",
        "end",
        "while (not (ready == True)):",
        "sync()",
        "end",
    ]


def test_names_of_signals_are_the_installations(build: Build, tmp_path: Path) -> None:
    names_of = '<IOs><DigitalOutputNames value=", , valve, , , , , "/></IOs>'
    step = build.node(
        "Set",
        inside='<pin referencedName="valve"/><digitalValue>1</digitalValue>',
        type="DigitalOutput",
    )
    program = opened(build, tmp_path, step, parts=names_of)
    assert any("set_standard_digital_out(2, True)" in str(one) for one in program.statements)
    (note,) = told(build, step)
    assert "'valve'" in note or "(valve)" in note


def test_a_wait_of_known_time_is_one(build: Build, tmp_path: Path) -> None:
    step = build.node("Wait", inside="<waitTime>1.5</waitTime>", type="Sleep")
    program = opened(build, tmp_path, build.move(build.fixed("A", A)), step)
    assert [one.duration for one in program.statements if isinstance(one, Wait)] == [1.5]


def test_subprograms_threads_and_script_files(build: Build, tmp_path: Path) -> None:
    sub = build.node("SubProgram", build.move(build.fixed("S", C)), name="Sub 1")
    lamp = '<pin referencedName="digital_out[1]"/><digitalValue>1</digitalValue>'
    thread = build.node("Thread", build.node("Set", inside=lamp, type="DigitalOutput"), name="T")
    call = '<CallSubProgram><SubProgram reference="../../../../SubProgram"/></CallSubProgram>'
    code = build.script("def go(q):\n  movej(q)\nend\ngo([0, -1, 1, 0, 1, 0]) # < & >\n")
    line = build.node("Script", inside=build.expression("go(A_q)"), type="Line")
    program = opened(
        build, tmp_path, build.move(build.fixed("A", A)), call, code, line, top=sub + thread
    )
    assert len(program.moves) == 4 and names(program)[:2] == ["A_p", "S_p"]


def test_what_is_not_carried_out_is_told_with_its_place(build: Build) -> None:
    steps = (
        build.node("Contributed", strategyProgramNodeType="Close", strategyURCapName="OnRobot"),
        build.node("Event", build.move(build.fixed("A", A)), name="Ev"),
        build.node(
            "Folder", build.node("Seek", build.move(build.fixed("A", A)), name="S"), name="F"
        ),
        build.node("Timer", type="Start"),
        build.node("Loop", type="Forever", checkContinuously="true"),
        build.move('<Waypoint type="Fixed" name="W"/>'),
        build.node("Assignment", inside=build.expression("1"), valueSource="Expression"),
    )
    notes = told(build, *steps)
    for node, text in (
        ("Robot Program > Close", "whose code is not in the program tree"),
        ("Robot Program > Ev", "not carried out"),
        ("Robot Program > F > S", "'Seek', whose code is not in the program tree"),
        ("Robot Program", "timers are not followed"),
        ("Robot Program > Loop", "checked continuously"),
        ("Robot Program > MoveJ > W", "never taught"),
        ("Robot Program > ?:=…", "no variable was chosen"),
    ):
        assert any(note.startswith(f"job.urp: {node}: ") and text in note for note in notes), text
    assert len(notes) == 7


def test_an_operator_is_asked(build: Build) -> None:
    ask = '<Assignment valueSource="Operator" message="how many?"><variable name="n"/></Assignment>'
    popup = build.node("Popup", type="Warning", haltProgram="true", message='the "box" is full')
    assert script(build, ask, popup) == [
        'global n=request_float_from_primary_client("how many?")',
        'popup("the \'box\' is full", title="Warning", warning=True, error=False, blocking=True)',
        "halt",
    ]


def test_a_subprogram_may_stand_inside_its_call(build: Build, tmp_path: Path) -> None:
    sub = build.node("SubProgram", build.move(build.fixed("S", C)), name="inner")
    again = (
        '<CallSubProgram><SubProgram reference="../../CallSubProgram/SubProgram"/></CallSubProgram>'
    )
    steps = build.move(build.fixed("A", A)), f"<CallSubProgram>{sub}</CallSubProgram>", again
    assert names(opened(build, tmp_path, *steps)) == ["A_p", "S_p", "S_p"]


def test_expressions_name_waypoints_and_features(build: Build, tmp_path: Path) -> None:
    inside = (
        '<variable name="v"/><expression><ExpressionToken token="pose_trans"/>'
        '<ExpressionChar character="("/><ExpressionFeature referencedName="Joint_0_name"/>'
        '<ExpressionChar character=","/><ExpressionWaypoint>'
        '<Waypoint reference="../../../../Move/children/Waypoint"/>'
        '</ExpressionWaypoint><ExpressionChar character=")"/></expression>'
    )
    assigned = f'<Assignment valueSource="Expression">{inside}</Assignment>'
    step = build.move(build.fixed("A", A), build.fixed("B", B), kind="MoveL")
    program = opened(
        build, tmp_path, step, assigned, build.move(VARIABLE.format("v"), kind="MoveL")
    )
    first, _, last = (move.target for move in program.moves)
    assert isinstance(first, PoseTarget) and isinstance(last, PoseTarget)
    assert last.pose.position == pytest.approx(first.pose.position, abs=1e-12)
