"""Changed programs → the user's own RAPID files: which bytes change, what is refused."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError, MotionError
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, ContourFraction, Radius
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import ReadOptions, read_with
from flyby.core.source.text.files import SourceFile, decode
from flyby.core.source.write.options import PatcherOptions, Sharing
from flyby.testing import strategies as given_by
from flyby.vendors.abb.motion.configuration import AbbConfiguration
from flyby.vendors.abb.patch.patcher import patch
from flyby.vendors.abb.run.reader import read_sources
from flyby.vendors.abb.values import predefined
from flyby.vendors.abb.write.options import RapidOptions
from flyby.vendors.abb.write.writer import write

OWN = PatcherOptions(Sharing.OWN, Sharing.OWN)
REFUSE = PatcherOptions()
FILE = "job.mod"
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
Z10 = predefined.zone("z10")
Z20 = predefined.zone("z20")
V100 = predefined.speed("v100")
assert isinstance(Z10, Radius) and isinstance(Z20, Radius) and V100 is not None

DATA = f"""\
    ! Zonen & Ziele – geteilt
    CONST robtarget p1:=[[500,0,800.00],[0.7071,0,0.7071,0],[0,0,0,0],{UNUSED}];   ! taught
    CONST robtarget p2:=[[500, -100.5 ,  800],[0,0,1,0],[0,-1,0,1],{UNUSED}];
    CONST jointtarget j1:=[[0,-10.0,20,0,60,0],{UNUSED}];
    PERS zonedata zOwn:=[FALSE,10,15,15,1.5,15,1.5];
    CONST zonedata zStop:=[ TRUE, ! stop
        0,0,0,0,0,0];
    LOCAL VAR speeddata vOwn:=[ 250,500,5000,1000 ];
    CONST robtarget path{{2}}:=[[[400,0,700],[0,0,1,0],[0,0,0,0],{UNUSED}],
        [[400,50,700],[0,0,1,0],[0,0,0,0],{UNUSED}]];
"""


def module(*lines: str, data: str = DATA, more: str = "") -> str:
    """A module with DATA and these instructions."""
    body = "".join(f"        {line}\n" for line in lines)
    return f"MODULE Job\n{data}    PROC main()\n{body}    ENDPROC\n{more}ENDMODULE\n"


def program_of(files: Mapping[str, str | bytes], main: str = FILE) -> Program:
    sources = {name: SourceFile(name, *decode(text, name)) for name, text in files.items()}
    options = ReadOptions(others=tuple(n for n in files if n != main))  # type: ignore[arg-type]
    return read_with(sources, main, options, read_sources)


def changed(program: Program, index: int, **parts: object) -> Program:
    moves = list(program.moves)
    moves[index] = replace(moves[index], **parts)  # type: ignore[arg-type]
    return program.with_moves(tuple(moves))


def moved(target: Any, *, x: float | None = None, z: float | None = None) -> Any:
    """The pose elsewhere, m."""
    at = target.pose.position
    position = (at[0] if x is None else x, at[1], at[2] if z is None else z)
    return replace(target, pose=replace(target.pose, position=position))


def patched(
    text: str, change: Callable[[Program], Program], options: PatcherOptions = REFUSE
) -> str:
    files = patch(change(program_of({FILE: text})), options)
    return files[FILE].text if files else text


Change = Callable[[Program], Program]


def target(index: int, **to: float) -> Change:
    return lambda p: changed(p, index, target=moved(p.moves[index].target, **to))


def zone(index: int, to: Callable[[Any], Any]) -> Change:
    return lambda p: changed(p, index, zone=to(p.moves[index].zone))


def speed(index: int, **to: Any) -> Change:
    return lambda p: changed(p, index, speed=replace(p.moves[index].speed, **to))


def sized(tcp: float) -> Callable[[Any], Any]:
    return lambda z: replace(z, tcp=tcp, name=None)


MOVE = "MoveL p2,v100,z10,tool0;"

IN_PLACE = {
    "a coordinate, and no other digit": (
        ["MoveJ p1, v100, z10, tool0;"],
        target(0, x=0.5125),
        ("[[500,0,800.00]", "[[512.5,0,800.00]"),
    ),
    "a sign goes with its number": (
        [MOVE],
        lambda p: changed(
            p,
            0,
            target=replace(
                p.moves[0].target, pose=replace(p.moves[0].target.pose, position=(0.5, 0.02, 0.8))
            ),
        ),
        ("[[500, -100.5 ,  800]", "[[500, 20 ,  800]"),
    ),
    "a quaternion as a whole": (
        [MOVE],
        lambda p: changed(
            p,
            0,
            target=replace(
                p.moves[0].target,
                pose=replace(p.moves[0].target.pose, quaternion=(0.0, 0.6, 0.8, 0.0)),
            ),
        ),
        ("[0,0,1,0],[0,-1", "[0,0.6,0.8,0],[0,-1"),
    ),
    "a configuration": (
        [MOVE],
        lambda p: changed(
            p, 0, target=replace(p.moves[0].target, configuration=AbbConfiguration(-1, -1, 0, 1))
        ),
        ("[0,-1,0,1]", "[-1,-1,0,1]"),
    ),
    "a joint": (
        ["MoveAbsJ j1\\NoEOffs,v100,z10,tool0;"],
        lambda p: changed(p, 0, target=JointTarget((0.0, 0.0, *p.moves[0].target.joints[2:]))),
        ("[0,-10.0,20", "[0,0,20"),
    ),
    "an element of an array": (
        ["MoveL path{1},v100,z10,tool0;", "MoveL path{2},v100,z10,tool0;"],
        target(1, z=0.65),
        ("[[400,50,700]", "[[400,50,650]"),
    ),
    "a literal at the move": (
        [f"MoveL [[400,0,700],[0,0,1,0],[0,0,0,0],{UNUSED}],v100,z10,tool0;"],
        target(0, x=0.41),
        ("MoveL [[400,", "MoveL [[410,"),
    ),
    "an own zone": (
        ["MoveL p2,v100,zOwn,tool0;"],
        zone(0, sized(0.0125)),
        ("FALSE,10,15", "FALSE,12.5,15"),
    ),
    "an own zone becomes a stop": (
        ["MoveL p2,v100,zOwn,tool0;"],
        zone(0, lambda z: FINE),
        ("v100,zOwn", "v100,fine"),
    ),
    "an own stop becomes a zone": (
        ["MoveL p2,v100,zStop,tool0;"],
        zone(0, lambda z: Radius(0.005, 0.008, 0.008)),
        ("[ TRUE, ! stop\n        0,0,0,", "[ FALSE, ! stop\n        5,8,8,"),
    ),
    "an own speed": (
        ["MoveL p2,vOwn,z10,tool0;"],
        speed(0, tcp=0.1755),
        ("[ 250,500", "[ 175.5,500"),
    ),
    "\\V": (["MoveL p2,v200\\V:=150,z10,tool0;"], speed(0, tcp=0.16), ("\\V:=150", "\\V:=160")),
    "\\T": (["MoveL p2,v200\\T:=2,z10,tool0;"], speed(0, duration=2.5), ("\\T:=2", "\\T:=2.5")),
    "\\Z": (
        ["MoveL p2,v200,z10\\Z:=12,tool0;"],
        zone(0, sized(0.014)),
        ("\\Z:=12", "\\Z:=14"),
    ),
    "\\Z of an own zone": (
        ["MoveL p2,v200,zOwn\\Z:=12,tool0;"],
        zone(0, sized(0.014)),
        ("\\Z:=12", "\\Z:=14"),
    ),
}

AT_THE_MOVE = {
    "another predefined zone": (zone(0, lambda z: Z20), "MoveL p2,v100,z20,tool0;"),
    "fine": (zone(0, lambda z: FINE), "MoveL p2,v100,fine,tool0;"),
    "a zone of another radius": (zone(0, sized(0.0125)), "MoveL p2,v100,z10\\Z:=12.5,tool0;"),
    "a predefined speed": (speed(0, tcp=0.2), "MoveL p2,v200,z10,tool0;"),
    "another speed": (speed(0, tcp=0.0875), "MoveL p2,v100\\V:=87.5,z10,tool0;"),
    "a duration": (speed(0, duration=3.0), "MoveL p2,v100\\T:=3,z10,tool0;"),
}


@pytest.mark.parametrize(("lines", "change", "edit"), IN_PLACE.values(), ids=IN_PLACE)
def test_a_number_is_changed_where_it_stands(
    lines: list[str], change: Change, edit: tuple[str, str]
) -> None:
    text = module(*lines)
    assert text.count(edit[0]) == 1
    assert patched(text, change) == text.replace(*edit)


@pytest.mark.parametrize(("change", "line"), AT_THE_MOVE.values(), ids=AT_THE_MOVE)
def test_the_controllers_own_data_are_replaced_at_the_move(change: Change, line: str) -> None:
    text = module(MOVE, "MoveJ p1, v100, z10, tool0;")
    assert patched(text, change) == text.replace(MOVE, line)


STOPS = {
    "z10\\Inpos:=inpos50": (lambda z: Z10, "z10"),
    "z50\\Inpos:=inpos20": (lambda z: Z20, "z20"),
    "fine": (lambda z: Z20, "z20"),
    "z10\\Z:=12": (lambda z: FINE, "fine"),
}


@pytest.mark.parametrize(("before", "to", "after"), [(b, *a) for b, a in STOPS.items()])
def test_stops_become_zones_and_zones_stops(
    before: str, to: Callable[[Any], Any], after: str
) -> None:
    text = module(f"MoveL p2,v100,{before},tool0\\WObj:=wobj0;")
    assert patched(text, zone(0, to)) == text.replace(before, after)


def test_a_time_is_taken_away() -> None:
    text = module("MoveL p2,v200\\T:=2,z10,tool0;")
    assert patched(text, speed(0, duration=None)) == text.replace("\\T:=2", "")


def test_a_zone_of_its_own_is_declared_beside_the_others() -> None:
    text = module(MOVE)
    new = patched(text, zone(0, lambda z: Radius(0.0125, 0.02, 0.02)))
    after = "        0,0,0,0,0,0];\n"
    declared = f"{after}    LOCAL CONST zonedata zFb_12_5:=[FALSE,12.5,20,20,0,0,0];\n"
    assert new == text.replace(after, declared).replace("v100,z10", "v100,zFb_12_5")


def test_data_of_one_value_are_declared_once_and_new_names_are_free_everywhere() -> None:
    lines = [MOVE, "MoveJ p1,v100,z10,tool0;"]
    other = "MODULE Other\n  PERS num zFb_12_5:=1;\nENDMODULE\n"
    before = program_of({FILE: module(*lines), "other.mod": other})
    own = Radius(0.0125, 0.02, 0.02)
    files = patch(changed(changed(before, 0, zone=own), 1, zone=own), REFUSE)
    assert list(files) == [FILE]
    assert files[FILE].text.count("LOCAL CONST zonedata zFb_12_5_2:=") == 1
    assert files[FILE].text.count("v100,zFb_12_5_2,tool0") == 2


SHARED = module(MOVE, "MoveJ p2,v100,z10,tool0;", "MoveJ p1,v100,z10,tool0;")


def test_shared_data_change_for_all_or_for_none() -> None:
    both = target(0, x=0.6)(target(1, x=0.6)(program_of({FILE: SHARED})))
    assert patch(both, REFUSE)[FILE].text == SHARED.replace("[[500, -100", "[[600, -100")
    with pytest.raises(MotionError, match=r"job\.mod:\d+:15: move 1: target: p2 .* move 2 as well"):
        patched(SHARED, target(0, x=0.6))


def test_a_move_gets_a_datum_of_its_own() -> None:
    new = patched(SHARED, target(0, x=0.6), OWN)
    declared = f"LOCAL CONST robtarget p2_2:=[[600,-100.5,800],[0,0,1,0],[0,-1,0,1],{UNUSED}];\n"
    kept = new.replace(f"    {declared}", "").replace("MoveL p2_2,", "MoveL p2,")
    assert declared in new and kept == SHARED


def test_moves_that_want_different_values_of_one_datum_are_named() -> None:
    two = target(0, x=0.6)(target(1, x=0.7)(program_of({FILE: SHARED})))
    with pytest.raises(MotionError, match=r"move 1: .* move 2 as well"):
        patch(two, REFUSE)
    text = patch(two, OWN)[FILE].text
    assert "p2_2:=[[600" in text and "p2_3:=[[700" in text


def test_a_literal_that_an_expression_reads_is_left_to_it() -> None:
    text = module(MOVE, "MoveL Offs(p2,0,0,50),v100,z10,tool0;")
    with pytest.raises(InputError, match=r"move 2 has another target"):
        patched(text, target(0, x=0.6))
    assert "MoveL p2_2,v100" in patched(text, target(0, x=0.6), OWN)


def test_what_the_program_computes_is_refused_or_gets_a_datum() -> None:
    text = module("MoveL Offs(p2,0,0,50),v100,z10,tool0;", "MoveL p2,v100,fine,tool0;")
    with pytest.raises(MotionError, match=r"move 1: target: the program computes it.*own=True"):
        patched(text, target(0, z=0.9))
    new = patched(text, target(0, z=0.9), OWN)
    assert "p2_2:=[[500,-100.5,900],[0,0,1,0],[0,-1,0,1]" in new
    assert "MoveL p2_2,v100,z10,tool0;" in new and "MoveL p2,v100,fine" in new


def test_an_instruction_that_runs_with_several_values_keeps_its_expression() -> None:
    text = module("FOR i FROM 1 TO 3 DO", "  MoveL Offs(p2,0,0,i*10),v100,z10,tool0;", "ENDFOR")
    with pytest.raises(MotionError, match="executed several times"):
        patched(text, target(1, z=0.9), OWN)
    with pytest.raises(MotionError, match="executed several times"):
        patched(text, zone(1, lambda z: FINE))

    def all_zones(p: Program) -> Program:
        return p.with_moves(tuple(replace(m, zone=FINE) for m in p.moves))

    assert patched(text, all_zones) == text.replace("z10", "fine")


def test_arguments_are_followed_to_their_datum() -> None:
    routine = "    PROC go(robtarget p,zonedata z)\n        MoveL p,v100,z,tool0;\n    ENDPROC\n"
    text = module("go p1,zOwn;", "go p2,zStop;", more=routine)
    assert patched(text, target(1, x=0.6)) == text.replace("[[500, -100", "[[600, -100")
    assert patched(text, zone(0, sized(0.009))) == text.replace("FALSE,10,15", "FALSE,9,15")


def test_an_arc_has_two_points() -> None:
    text = module(MOVE, "MoveC p1,path{1},v100,z10,tool0;")

    def via(p: Program) -> Program:
        move = p.moves[1]
        assert isinstance(move, MoveC)
        return changed(p, 1, via=moved(move.via, x=0.51))

    assert patched(text, via) == text.replace("[[500,0,800.00]", "[[510,0,800.00]")


ENDS = ["\r\n", "\n", "\r"]


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("codec", ["cp1252", "utf-8", "utf-8-sig"])
@pytest.mark.parametrize("final", [True, False])
def test_every_other_byte_is_kept(end: str, codec: str, final: bool) -> None:
    header = "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n\n"
    text = (header + module(MOVE, "MoveJ p1,v100,z10,tool0;")).replace("    ", "\t")
    text = text.replace("\n", end).removesuffix("" if final else end)
    program = program_of({FILE: text.encode(codec)})
    change = target(0, x=0.61)(zone(1, lambda z: Radius(0.0125, 0.02, 0.02))(program))
    (file,) = patch(change, REFUSE).values()
    new = file.data.decode(codec)
    declared = f"{end}\tLOCAL CONST zonedata zFb_12_5:=[FALSE,12.5,20,20,0,0,0];"
    assert new.count(declared) == 1
    back = new.replace(declared, "").replace("zFb_12_5", "z10").replace("[[610,", "[[500,")
    assert back == text and file.data.endswith(end.encode()) == final


HEADS = {
    "MODULE A PROC main() MoveL DATUM,v100,z10,tool0; ENDPROC ENDMODULE": "MODULE A LOCAL CONST",
    "MODULE A(SYSMODULE, NOSTEPIN) ! head\r\n  PROC main()\r\n    MoveL DATUM,v100,z10,tool0;\r\n"
    "  ENDPROC\r\nENDMODULE": "! head\r\n  LOCAL CONST zonedata",
    "MODULE A\n\n\tRECORD r\n\t\tnum a;\n\tENDRECORD\n\n\tPROC main()\n\t\tMoveL DATUM,v100,z10,"
    "tool0;\n\tENDPROC\nENDMODULE": "\tENDRECORD\n\tLOCAL CONST zonedata",
    "MODULE A\n  VAR num n; PROC main()\n MoveL DATUM,v100,z10,tool0;\n ENDPROC\nENDMODULE": (
        "VAR num n;\n  LOCAL CONST zonedata"
    ),
}


@pytest.mark.parametrize(("text", "declared"), HEADS.items())
def test_a_new_datum_finds_its_place_in_any_module(text: str, declared: str) -> None:
    text = text.replace("DATUM", f"[[400,0,700],[0,0,1,0],[0,0,0,0],{UNUSED}]")
    assert declared in patched(text, zone(0, lambda z: Radius(0.0125, 0.02, 0.02)))


REFUSED: dict[str, tuple[Change, str]] = {
    "tool": (lambda p: changed(p, 0, tool=replace(p.moves[0].tool, name="x", robot_held=False)),
             "its tool has changed"),
    "AccSet": (speed(0, jerk_fraction=0.5), "jerk fraction.* has changed"),
    "joint speed": (speed(0, joint=1.0), "no words for a joint speed"),
    "share of the joints' speed": (speed(0, joint_fraction=0.5), "hold the joints"),
    "contour": (zone(0, lambda z: ContourFraction(0.5)), "no zone by ContourFraction"),
    "narrow orientation zone": (zone(0, sized(0.05)), "at least as large"),
    "no configuration": (
        lambda p: changed(p, 0, target=replace(p.moves[0].target, configuration=None)),
        "another target",
    ),
    "kind of target": (
        lambda p: changed(p, 0, target=JointTarget((0.0,) * 6)),
        "is a jointtarget, a robtarget is wanted|another target",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("change", "message"), REFUSED.values(), ids=REFUSED)
def test_what_no_patch_says_is_refused(change: Change, message: str) -> None:
    with pytest.raises(FlybyError, match=message):
        patched(module(MOVE), change)


def test_other_statements_and_other_programs_are_refused() -> None:
    program = program_of({FILE: module(MOVE, "SetDO d,1;", MOVE)})
    with pytest.raises(InputError, match="other statements"):
        patch(replace(program, statements=program.statements[1:]), REFUSE)
    with pytest.raises(InputError, match="not read from source files"):
        patch(Program(program.statements), REFUSE)


def test_nothing_changed_gives_no_file() -> None:
    program = program_of({FILE: module(MOVE, "MoveJ p1,v100,z10,tool0;")})
    assert patch(program, REFUSE) == {}


NUMBERS = st.floats(-3.0, 3.0, allow_subnormal=False)
POSITIONS = st.tuples(NUMBERS, NUMBERS, NUMBERS)
CONFIGURATIONS = st.builds(AbbConfiguration, *[st.integers(-2, 1)] * 3, st.integers(0, 7))


@st.composite
def _targets(draw: st.DrawFn) -> PoseTarget | JointTarget:
    name = draw(st.sampled_from((None, "p10", "pHome", "p2")))
    if draw(st.booleans()):
        return JointTarget(tuple(draw(NUMBERS) for _ in range(6)), name=name)
    pose = replace(draw(given_by.poses()), position=draw(POSITIONS))
    return PoseTarget(pose, draw(st.none() | CONFIGURATIONS), name=name)


@st.composite
def changes(draw: st.DrawFn) -> tuple[Program, Program]:
    """A program as it is read, of which several moves read the same data, and another one."""
    targets = draw(st.lists(_targets(), min_size=1, max_size=3))
    speeds = draw(st.lists(given_by.speeds(), min_size=1, max_size=2))
    zones = draw(st.lists(given_by.zones(), min_size=1, max_size=2))
    moves = []
    for _ in range(draw(st.integers(1, 6))):
        target = draw(st.sampled_from(targets))
        kind = MoveJ if isinstance(target, JointTarget) else draw(st.sampled_from((MoveJ, MoveL)))
        moves.append(kind(target, draw(st.sampled_from(speeds)), draw(st.sampled_from(zones))))
    before = program_of({FILE: write(Program(tuple(moves)), RapidOptions())})
    return before, before.with_moves(tuple(draw(_another(move)) for move in before.moves))


@st.composite
def _another(draw: st.DrawFn, move: Move) -> Move:
    kind = draw(st.sampled_from(("nothing", "target", "zone", "speed", "all")))
    if kind in ("target", "all"):
        move = replace(move, target=draw(_another_target(move.target)))
    if kind in ("zone", "all"):
        move = replace(move, zone=draw(given_by.zones()))
    if kind in ("speed", "all"):
        tcp = draw(st.floats(1e-3, 7.0))
        move = replace(move, speed=replace(move.speed, tcp=tcp, duration=None, name=None))
    return move


@st.composite
def _another_target(draw: st.DrawFn, target: PoseTarget | JointTarget) -> PoseTarget | JointTarget:
    if isinstance(target, JointTarget):
        return replace(target, joints=tuple(draw(NUMBERS) for _ in target.joints))
    turned = draw(given_by.poses()).quaternion
    return replace(target, pose=replace(target.pose, position=draw(POSITIONS), quaternion=turned))


@given(changes())
def test_a_patch_gives_the_changed_program_or_nothing(pair: tuple[Program, Program]) -> None:
    before, after = pair
    reading: Any = before.reading
    text = reading.files[FILE].text
    try:
        files = patch(after, OWN)
    except FlybyError as error:
        event(f"refused: {str(error)[:40]}")
        assert reading.files[FILE].text == text
        return
    new = files[FILE].text if files else text
    assert difference(after, program_of({FILE: new})) is None
    fresh = [line for line in new.splitlines() if "LOCAL CONST" in line]
    assert len(new.splitlines()) == len(text.splitlines()) + len(fresh)
    assert bool(files) == (difference(before, after) is not None)


@settings(max_examples=40)
@given(changes())
def test_a_patch_of_a_patch_leads_back(pair: tuple[Program, Program]) -> None:
    before, after = pair
    try:
        files = patch(after, OWN)
    except FlybyError:
        return
    if files:
        there = program_of({FILE: files[FILE].text})
        back = patch(there.with_moves(before.moves), OWN)
        text = back[FILE].text if back else files[FILE].text
        assert difference(before, program_of({FILE: text})) is None


@pytest.mark.parametrize("options", [REFUSE, OWN])
def test_what_is_computed_of_a_point_goes_with_it(options: PatcherOptions) -> None:
    """Both are to be 20 mm away: the point's number changes, and the offset stays."""
    text = module("MoveL Offs(p2,0,0,50), v100, z10, tool0;", "MoveL p2, v100, fine, tool0;")
    program = program_of({FILE: text})
    moves = tuple(
        replace(move, target=moved(move.target, x=0.52))
        for move in program.moves
        if isinstance(move, MoveL)
    )
    (file,) = patch(program.with_moves(moves), options).values()
    assert file.text == text.replace("[[500, -100.5 ,", "[[520, -100.5 ,")
