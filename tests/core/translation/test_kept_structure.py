"""Loops and routines that are kept drive the same moves as all of them one after the other."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import MotionError
from flyby.core.program.move import Opaque
from flyby.core.program.target import PoseTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.core.spatial.pose import Pose
from flyby.core.translation.hand_out import check_driven
from flyby.core.translation.signals import SignalMap
from flyby.core.translation.translate import translate

OLD, NEW = "abb/irb1600-6-145", ("kuka/kr30-3", "ur/ur10e")
SIGNALS = SignalMap.of(
    {"doGrip": ["$OUT[3]", "digital_out[1]"], "diPart": ["$IN[7]", "digital_in[0]"]}
)
HEAD = """MODULE Cell
  VAR robtarget q;
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
  CONST robtarget p0:=[[1050,0,650],[0,0,1,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p1:=[[1000,150,550],[0,0,1,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfJ \\Off;
    ConfL \\Off;
    MoveJ p0, v500, fine, tGrip;
    q:=p1;
"""
PLACES = (
    *("p1", "Offs(p1,50,0,0)", "Offs(p1,0,-80,40)", "Offs(p1,30,20*n,0)"),
    *("q", "Offs(q,0,0,30)", "Offs(q,0,10*n,-20)", "RelTool(q,0,0,-25)"),
)
BODY = st.lists(
    st.one_of(
        st.builds(
            "Move{} {}, v{}, {}, tGrip;".format,
            st.sampled_from("JL"),
            st.sampled_from(PLACES),
            st.sampled_from([200, 500]),
            st.sampled_from(["fine", "z10", "z20"]),
        ),
        st.sampled_from(
            [
                "Set doGrip;",
                "Reset doGrip;",
                "WaitDI diPart,1;",
                "WaitTime 0.2;",
                'TPWrite "a";',
                "SetDO doLamp, 1;",
            ]
        ),
    ),
    min_size=1,
    max_size=4,
)


def options(cycles: int = 1) -> ReadOptions:
    return ReadOptions(None, find_robot(OLD), Answers(cycles=cycles, goes_on=True))


def indented(lines: list[str], n: int = 2) -> list[str]:
    return [" " * n + line for line in lines]


def counted(body: list[str], count: int) -> list[str]:
    return [f"FOR i FROM 1 TO {count} DO", *(line.replace("*n", "*i") for line in body), "ENDFOR"]


@st.composite
def sources(draw: st.DrawFn) -> str:
    """A program of routines with arguments, loops that count and one without an end."""
    step = st.one_of(
        st.tuples(st.integers(0, 1), st.sampled_from(["p0", "p1", "Offs(p1,0,40,0)"])).map(
            lambda given: [f"rWork {given[0]},{given[1]};"]
        ),
        st.tuples(st.integers(1, 3), st.integers(1, 2), BODY).map(
            lambda b: [
                f"FOR i FROM 1 TO {b[0]} DO",
                f"FOR j FROM {b[1]} TO 0 STEP -1 DO",
                "rWork j,Offs(p1,15*i,-25*j,0);",
                *[x.replace("n,", "i,") for x in b[2]],
                "ENDFOR",
                "ENDFOR",
            ]
        ),
        st.tuples(BODY, st.integers(1, 3)).map(
            lambda b: [
                f"FOR i FROM 1 TO {b[1]} DO",
                *[x.replace("n,", "i,") for x in b[0]],
                "ENDFOR",
            ]
        ),
        BODY.map(lambda body: [line.replace("20*n", "20") for line in body]),
    )
    steps = [line for block in draw(st.lists(step, min_size=1, max_size=4)) for line in block]
    if draw(st.booleans()):
        steps = ["WHILE TRUE DO", *steps, "ENDWHILE"]
    work = draw(BODY)
    return "\n".join(
        [
            HEAD,
            *indented(steps, 4),
            "  ENDPROC",
            "  PROC rWork(num n,robtarget q)",
            *indented(work, 4),
            "  ENDPROC",
            "ENDMODULE",
            "",
        ]
    )


def made_of(text: str, name: str, cycles: int = 1, keep: bool = True, signals: SignalMap = SIGNALS):
    old, new = find_vendor("abb"), find_vendor(name.split("/")[0])
    if name.startswith("ur/"):  # nearer, where it reaches
        text = text.replace("[[1050,0,650]", "[[700,0,350]").replace(
            "[[1000,150,550]", "[[650,150,250]"
        )
    program = old.reader.read(text, "cell.mod", options(cycles))
    sides = (old, find_robot(OLD)), (new, find_robot(name))
    return translate(program, *sides, keep=keep, signals=signals)


def written(made, name: str, structure: str) -> dict[str, str]:
    vendor = find_vendor(name.split("/")[0])
    return vendor.write(made.program, find_robot(name), {"structure": structure})


def again(files: dict[str, str], name: str, tmp_path, cycles: int = 1):
    vendor = find_vendor(name.split("/")[0])
    for file, text in files.items():
        (tmp_path / file).write_text(text)
    main = next(file for file in files if file.endswith(vendor.suffixes))
    read = ReadOptions(None, find_robot(name), Answers(cycles=cycles))
    return vendor.reader.read_file(tmp_path / main, read)


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(text=sources(), name=st.sampled_from(NEW))
def test_what_is_kept_drives_what_is_flat(text, name, tmp_path) -> None:
    try:
        made = made_of(text, name)
    except MotionError:
        assume(False)  # it goes nowhere
    kept = again(written(made, name, "keep"), name, tmp_path)
    flat = again(written(made, name, "flat"), name, tmp_path)
    assert len(kept.moves) == len(flat.moves) == len(made.program.moves)
    for one, other in zip(kept.moves, flat.moves, strict=True):
        assert type(one) is type(other)
        assert one.zone == other.zone
        assert replace(one.speed, name=None) == replace(other.speed, name=None)
        assert (one.tool.tcp, one.load) == (other.tool.tcp, other.load)
        if isinstance(one.target, PoseTarget):
            assert near(one.target.pose, other.target.pose)
    kinds = [[s.text.split() for s in p.statements if isinstance(s, Opaque)] for p in (kept, flat)]
    assert kinds[0] == kinds[1]


PICKS = (
    HEAD
    + """    WHILE TRUE DO
      rPick;
      FOR i FROM 1 TO 5 DO
        MoveL Offs(p1,0,-50,100), v500, z10, tGrip;
        MoveL Offs(p1,0,50,100), v500, z10, tGrip;
      ENDFOR
      rPick;
    ENDWHILE
  ENDPROC
  PROC rPick()
    MoveJ Offs(p1,0,0,100), v500, z20, tGrip;
    MoveL p1, v200, fine, tGrip;
    Set doGrip;
    WaitTime 0.2;
    MoveL Offs(p1,0,0,100), v200, z20, tGrip;
  ENDPROC
ENDMODULE
"""
)


@pytest.mark.parametrize("name", NEW)
def test_loops_and_routines_stand_in_the_new_program(name) -> None:
    made = made_of(PICKS, name, cycles=2)
    assert len(made.program.moves) == 17  # one pass of the loop without an end
    (text,) = (t for f, t in written(made, name, "keep").items() if not f.endswith(".dat"))
    words = {
        "kuka": ("LOOP", "FOR flyby_1=1 TO 5", "rPick( )", "DEF rPick( )"),
        "ur": ("while True:", "while flyby_1 < 5:", "rPick()", "def rPick():"),
    }[name.split("/")[0]]
    assert all(word in text for word in words), text
    calls = words[2] if name.startswith("kuka") else f" {words[2]}"
    assert text.count(calls) - text.count(words[3]) == 2
    flat = "".join(written(made_of(PICKS, name, keep=False), name, "keep").values())
    assert "rPick" not in flat


def test_the_zone_of_the_last_pass_is_that_of_all_although_the_robot_stops_there() -> None:
    text = (
        HEAD
        + """    FOR i FROM 1 TO 3 DO
      MoveL Offs(p1,0,-50,0), v500, z10, tGrip;
      MoveL Offs(p1,0,50,0), v500, z10, tGrip;
    ENDFOR
    WaitTime 0.5;
    MoveL p0, v500, fine, tGrip;
  ENDPROC
ENDMODULE
"""
    )
    moves = made_of(text, "kuka/kr30-3").program.moves
    assert isinstance(moves[6].zone, Radius)
    assert [moves[k].zone for k in (1, 3, 5)] == [moves[1].zone] * 3
    assert not isinstance(made_of(text, "kuka/kr30-3", keep=False).program.moves[6].zone, Radius)


def near(one: Pose, other: Pose) -> bool:
    pairs = zip((*one.position, *one.quaternion), (*other.position, *other.quaternion), strict=True)
    return all(abs(a - b) < 1e-7 for a, b in pairs)


PALLET = (
    HEAD
    + """    FOR r FROM 0 TO 2 DO
      FOR c FROM 0 TO 1 DO
        rPlace Offs(p1,r*40,c*60,0);
      ENDFOR
    ENDFOR
    rPlace p0;
    MoveJ Offs(p0,0,0,100), v500, fine, tGrip;
    MoveL p0, v500, fine, tGrip;
  ENDPROC
  PROC rPlace(robtarget p)
    rGo p;
    Reset doGrip;
    MoveL Offs(p,0,0,50), v300, z10, tGrip;
  ENDPROC
  PROC rGo(robtarget p)
    MoveL Offs(p,0,0,50), v500, z20, tGrip;
    MoveL p, v200, fine, tGrip;
  ENDPROC
ENDMODULE
"""
)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        (
            "kuka/kr30-3",
            [
                "FOR flyby_1=1 TO 3",
                "flyby_x1.X=flyby_x1.X+40*(flyby_1-1)",
                "flyby_x1.Y=flyby_x1.Y+60*(flyby_2-1)",
                "rPlace(flyby_x1)",
                "DEF rPlace(flyby_p1:IN)",
                "DECL E6POS flyby_p1",
                "flyby_x1.Z=flyby_x1.Z+50",
            ],
        ),
        (
            "ur/ur10e",
            [
                "while flyby_1 < 3:",
                ", p[0.04*flyby_1, 0.06*flyby_2, 0, 0, 0, 0]))",
                "def rPlace(flyby_p1):",
                "rGo(flyby_p1)",
                "pose_add(flyby_p1, p[0, 0, 0.05, 0, 0, 0])",
                "pose_add(p0, p[0, 0, 0.1, 0, 0, 0])",
            ],
        ),
        (
            "abb/irb2600-12-165",
            [
                "FOR flyby_1 FROM 1 TO 3 DO",
                "rPlace Offs(p10,40*(flyby_1-1),60*(flyby_2-1),0);",
                "PROC rPlace(robtarget flyby_p1)",
                "rGo flyby_p1;",
                "MoveL Offs(flyby_p1,0,0,50)",
                "MoveJ Offs(p0,0,0,100)",
            ],
        ),
    ],
)
def test_offsets_and_arguments_are_said_in_the_new_language(name, words, tmp_path) -> None:
    made = made_of(PALLET, name)
    files = written(made, name, "keep")
    text = next(t for f, t in files.items() if not f.endswith(".dat"))
    assert [word for word in words if word not in text] == []
    assert not any("differ" in n.message or "something else" in n.message for n in made.losses)
    kept = again(files, name, tmp_path)
    pairs = zip(kept.moves, made.program.moves, strict=True)
    assert all(near(one.target.pose, other.target.pose) for one, other in pairs)


def test_a_frame_of_the_source_turns_offsets_into_the_base() -> None:
    text = PALLET.replace(
        "  VAR robtarget q;",
        '  PERS wobjdata wT:=[FALSE,TRUE,"",[[0,0,0],[0.5,0,0,0.8660254]],[[0,0,0],[1,0,0,0]]];\n'
        "  VAR robtarget q;",
    )
    text = re.sub(r"tGrip;", r"tGrip\\WObj:=wT;", text).replace(
        "[0,0,1,0],[0,0,1,0]", "[0,0,1,0],[-2,0,0,0]"
    )
    text = text.replace("[[1050,0,650]", "[[-200,-650,350]").replace(
        "[[1000,150,550]", "[[-200,-600,250]"
    )
    made = made_of(text, "ur/ur10e")
    files = written(made, "ur/ur10e", "keep")
    assert "*flyby_1, " in files["Cell.script"]


def test_passes_that_differ_are_told_and_written_one_after_the_other() -> None:
    text = (
        HEAD
        + """    FOR i FROM 1 TO 3 DO
      MoveL Offs(p1,0,20*i*i,0), v500, fine, tGrip;
    ENDFOR
    rGo 0;
    rGo 2;
  ENDPROC
  PROC rGo(num n)
    MoveL p1, v500, fine, tGrip;
    IF n>1 MoveL p0, v500, fine, tGrip;
  ENDPROC
ENDMODULE
"""
    )
    made = made_of(text, "kuka/kr30-3")
    told = [note.message for note in made.losses]
    assert "FOR i: its passes differ, and are written one after the other" in told
    assert any(message.endswith("it is written as rGo and rGo_2") for message in told)
    assert not any("FOR" in text for text in written(made, "kuka/kr30-3", "keep").values())


def test_signals_are_carried_and_those_without_a_name_are_said() -> None:
    text = (
        HEAD
        + """    WaitUntil diPart=1 AND diDoor=0;
    MoveL p1, v500, z20, tGrip;
    Set doGrip;
    MoveL p0, v500, fine, tGrip;
    Reset doGrip;
    WaitDI diPart, 0;
    PulseDO \\PLength:=0.5, doGrip;
  ENDPROC
ENDMODULE
"""
    )
    kuka = made_of(text, "kuka/kr30-3")
    assert dict(kuka.unmapped) == {"diDoor": "$IN[?]"}
    assert [s.text for s in kuka.program.statements if isinstance(s, Opaque)] == [
        "; WaitUntil diPart=1 AND diDoor=0;",
        "$OUT[3]=FALSE",
        "WAIT FOR NOT $IN[7]",
        "PULSE($OUT[3],TRUE,0.5)",
    ]
    # KRL's assignment would stop the robot in its zone.
    assert [e.text for e in kuka.program.moves[1].events] == ["$OUT[3]=TRUE"]
    ur = made_of(text, "ur/ur10e").program
    texts = [s.text for s in ur.statements if isinstance(s, Opaque)]
    assert "set_standard_digital_out(1, True)" in texts
    assert "while get_standard_digital_in(0):" in texts
    assert texts[-1] == "# PulseDO \\PLength:=0.5, doGrip;"


@pytest.mark.parametrize("name", NEW)
def test_outputs_at_a_target_are_set_there(name) -> None:
    text = (
        HEAD
        + """    MoveLDO p1, v500, z20, tGrip, doGrip, 1;
    MoveL p0, v500, fine, tGrip;
  ENDPROC
ENDMODULE
"""
    )
    program = made_of(text, name).program
    if name.startswith("kuka/"):
        assert [e.text for e in program.moves[1].events] == ["$OUT[3]=TRUE"]
    else:
        assert isinstance(program.moves[1].zone, Radius)
        behind = program.statements[program.statements.index(program.moves[1]) + 1]
        assert behind == Opaque("set_standard_digital_out(1, True)")
    written(made_of(text, name), name, "keep")


def test_what_cannot_be_driven_as_written_is_refused_with_the_old_line() -> None:
    made = made_of(PICKS, "kuka/kr30-3", cycles=2)
    name, robot = "kuka/kr30-3", find_robot("kuka/kr30-3")
    files = written(made, name, "keep")
    check_driven(made, files, find_vendor("kuka"), robot)
    far = {file: text.replace("X 1000", "X 8000") for file, text in files.items()}
    with pytest.raises(MotionError, match="what would be written for kuka/kr30-3 is at fault") as e:
        check_driven(made, far, find_vendor("kuka"), robot)
    assert e.value.span.line == PICKS[: PICKS.index("    MoveJ Offs(p1,0,0,100)")].count("\n") + 1


def test_an_output_that_the_answers_call_an_input_is_not_set() -> None:
    text = HEAD + "    MoveL p1, v500, fine, tGrip;\n    Set doGrip;\n  ENDPROC\nENDMODULE\n"
    for robot, name in (("kuka/kr30-3", "$IN[3]"), ("ur/ur10e", "digital_in[1]")):
        made = made_of(text, robot, signals=SignalMap.of({"doGrip": [name]}))
        told = [note.message for note in made.losses]
        assert any(m.startswith(f"no program sets '{name}', which the answers") for m in told)
        lines = [s.text for s in made.program.statements if isinstance(s, Opaque)]
        assert all(line.startswith((";", "#")) for line in lines) and lines
