"""Changed programs go back into the user's own KRL files, and every other byte stays."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError
from flyby.core.program.move import Move, Wait
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import difference, reading_of
from flyby.vendors.kuka.motion.configuration import KukaConfiguration

KUKA = find_vendor("kuka")
ROBOT = KUKA.robot("kr30-3")
OWN = {"shared": "own", "derived": "own"}

SRC = """&ACCESS RVP\r
DEF job( )\r
;FOLD INI\r
BAS (#INITMOV,0 )\r
;ENDFOLD (INI)\r
BAS(#VEL_PTP,50)\r
$VEL.CP=0.5 ; langsam, wegen Größe\r
$APO.CDIS=10\r
$APO.CPTP=40\r
PTP XHOME\r
PTP XP1 C_PTP\r
  LIN XP2 C_DIS ;weiter\r
  LIN XP3\r
LIN {X 1250.5,Y 120,Z 905.25} C_DIS\r
CIRC XP4, XP5 C_DIS\r
LIN XP2:{X 0,Y 0,Z -40,A 0,B 0,C 0}\r
PTP XEND\r
PTP {A1 5,A2 -85,A3 95}\r
END"""
DAT = """DEFDAT job\r
DECL E6AXIS XHOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 45.0,A6 0.0}\r
DECL E6AXIS XEND={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 45.0,A6 0.0}\r
DECL E6POS XP1={X 1200.0,Y -100.0,Z 1000.0,A 0.0,B 0.0,C 180.0,S 2,T 34,E1 0.0}\r
DECL E6POS XP2={X 1200.0,Y 0.0,Z 900.0,A 0.0,B 0.0,C 180.0,S 2,T 35}\r
DECL E6POS XP3={X 1250.0,Y 50.0,Z 900.0,A 10.0,B 0.0,C 180.0}\r
DECL POS XP4={X 1270.0,Y 150.0,Z 900.0,A 10.0,B 0.0,C 180.0}\r
DECL POS XP5={X 1260.0,Y 190.0,Z 900.0,A 10.0,B 0.0,C 180.0}\r
ENDDAT\r
"""


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Program:
    folder = tmp_path_factory.mktemp("job")
    (folder / "job.src").write_bytes(SRC.encode("cp1252"))
    (folder / "job.dat").write_bytes(DAT.encode("cp1252"))
    return KUKA.read_file(folder / "job.src", robot=ROBOT)


Change = Callable[[Move], Move]


def changed(program: Program, changes: Mapping[int, Change]) -> Program:
    moves = tuple(changes[i](m) if i in changes else m for i, m in enumerate(program.moves))
    return program.with_moves(moves)


def patch(
    program: Program, changes: Mapping[int, Change], options: Mapping[str, str] | None = None
) -> tuple[str, str]:
    """The texts of .src and .dat after a patch."""
    wanted = changed(program, changes)
    new = {f.name: f for f in KUKA.patch(wanted, ROBOT, options).values()}
    files = {**reading_of(program).files, **new}
    assert difference(wanted, reading_of(program).again(files)) is None
    by_suffix = {Path(name).suffix: file for name, file in files.items()}
    for file in by_suffix.values():
        file.data.decode("cp1252")
    return by_suffix[".src"].text, by_suffix[".dat"].text


def to(x: float | None = None, y: float | None = None, z: float | None = None) -> Change:
    """Another place, mm."""

    def change(move: Move) -> Move:
        target = move.target
        assert isinstance(target, PoseTarget)
        old = target.pose.position
        new = [p if v is None else v / 1000 for p, v in zip(old, (x, y, z), strict=True)]
        pose = replace(target.pose, position=(new[0], new[1], new[2]))
        return replace(move, target=replace(target, pose=pose))

    return change


def zoned(zone: object) -> Change:
    return lambda move: replace(move, zone=zone)  # type: ignore[arg-type]


def ball(mm: float) -> Change:
    return zoned(Radius(mm / 1000, mm / 1000, mm / 1000))


def paced(**numbers: float) -> Change:
    return lambda move: replace(move, speed=replace(move.speed, **numbers))  # type: ignore[arg-type]


def test_nothing_changed_is_nothing_written(job: Program) -> None:
    assert KUKA.patch(job, ROBOT) == {}


def test_a_target_changes_in_the_data_list(job: Program) -> None:
    src, dat = patch(job, {3: to(x=1234.5678)})
    assert src == SRC
    assert dat == DAT.replace("XP3={X 1250.0", "XP3={X 1234.5678")


def test_a_target_changes_at_the_motion(job: Program) -> None:
    src, dat = patch(job, {4: to(y=121.25, z=905)})
    assert src == SRC.replace("Y 120,Z 905.25", "Y 121.25,Z 905")
    assert dat == DAT


def test_components_that_were_left_out_are_put_in(job: Program) -> None:
    def turned(move: Move) -> Move:
        assert isinstance(move.target, JointTarget)
        joints = (*move.target.joints[:5], math.radians(12))
        return replace(move, target=replace(move.target, joints=joints))

    src, _ = patch(job, {8: turned})
    assert src == SRC.replace("{A1 5,A2 -85,A3 95}", "{A1 5,A2 -85,A3 95,A6 12}")


def test_an_auxiliary_point_changes(job: Program) -> None:
    def moved(move: Move) -> Move:
        return replace(move, via=to(z=899)(replace(move, target=move.via)).target)  # type: ignore[attr-defined]

    _, dat = patch(job, {5: moved})
    assert dat == DAT.replace("XP4={X 1270.0,Y 150.0,Z 900.0", "XP4={X 1270.0,Y 150.0,Z 899")


def test_status_and_turn_stay_unless_the_configuration_changes(job: Program) -> None:
    _, dat = patch(job, {1: to(x=1201)})
    assert "XP1={X 1201,Y -100.0,Z 1000.0,A 0.0,B 0.0,C 180.0,S 2,T 34," in dat

    def labelled(move: Move) -> Move:
        target = replace(move.target, configuration=KukaConfiguration(2, 2))  # type: ignore[call-arg]
        return replace(move, target=target)

    _, dat = patch(job, {1: labelled})
    assert dat == DAT.replace("S 2,T 34,E1", "S 2,T 2,E1")


def test_a_literal_that_all_readers_want_alike_changes(job: Program) -> None:
    src, _ = patch(job, {2: ball(12.5), 4: ball(12.5), 5: ball(12.5)})
    assert src == SRC.replace("$APO.CDIS=10", "$APO.CDIS=12.5")
    src, _ = patch(job, {i: paced(tcp=0.35) for i in (2, 3, 4, 5, 6)})
    assert src == SRC.replace("$VEL.CP=0.5", "$VEL.CP=0.35")
    src, _ = patch(job, {i: paced(joint_fraction=0.25) for i in (0, 1, 7, 8)})
    assert src == SRC.replace("BAS(#VEL_PTP,50)", "BAS(#VEL_PTP,25)")


def test_a_literal_that_others_read_is_refused_or_gets_company(job: Program) -> None:
    with pytest.raises(FlybyError, match=r"move 3: zone: .* read by moves 5, 6 .*own=True"):
        KUKA.patch(changed(job, {2: ball(4)}), ROBOT)
    src, _ = patch(job, {2: ball(4)}, OWN)
    assert src == SRC.replace(
        "  LIN XP2 C_DIS ;weiter\r\n",
        "  $APO.CDIS=4\r\n  LIN XP2 C_DIS ;weiter\r\n  $APO.CDIS=10\r\n",
    )


@pytest.mark.parametrize("options", [{}, OWN])
def test_a_zone_with_parts_of_its_own_is_refused_for_what_it_is(job: Program, options) -> None:  # type: ignore[no-untyped-def]
    uneven = zoned(Radius(0.005, 0.01, 0.01))
    with pytest.raises(FlybyError, match=r"move 3: zone: KRL's C_DIS has one distance"):
        KUKA.patch(changed(job, dict.fromkeys((2, 4, 5), uneven)), ROBOT, options)


@pytest.mark.parametrize("mm", [4, 16])
def test_zones_grow_and_shrink_by_one_rule(job: Program, mm: int) -> None:
    def resized(move: Move) -> Move:
        assert isinstance(move.zone, Radius)
        return replace(move, zone=move.zone.resized(mm / 1000))

    def torn(move: Move) -> Move:
        return replace(move, zone=replace(move.zone, tcp=mm / 1000))  # type: ignore[call-arg]

    readers = (2, 4, 5)
    src, _ = patch(job, dict.fromkeys(readers, resized))
    assert src == SRC.replace("$APO.CDIS=10", f"$APO.CDIS={mm}")
    unsaid = changed(job, dict.fromkeys(readers, zoned(Radius(mm / 1000))))
    (file,) = KUKA.patch(unsaid, ROBOT).values()
    assert file.text == src
    with pytest.raises(FlybyError, match=r"move 3: zone: KRL's C_DIS has one .*resized"):
        KUKA.patch(changed(job, dict.fromkeys(readers, torn)), ROBOT)


def test_neighbours_with_settings_of_their_own_are_not_restored_between(job: Program) -> None:
    src, _ = patch(job, {4: paced(tcp=0.2), 5: paced(tcp=0.3)}, OWN)
    assert src == SRC.replace(
        "LIN {X 1250.5,Y 120,Z 905.25} C_DIS\r\nCIRC XP4, XP5 C_DIS\r\n",
        "$VEL.CP=0.2\r\nLIN {X 1250.5,Y 120,Z 905.25} C_DIS\r\n"
        "$VEL.CP=0.3\r\nCIRC XP4, XP5 C_DIS\r\n$VEL.CP=0.5\r\n",
    )


def test_what_is_computed_is_refused_or_gets_numbers(job: Program) -> None:
    with pytest.raises(FlybyError, match=r"move 7: target: the program computes it.*own=True"):
        KUKA.patch(changed(job, {6: to(z=950)}), ROBOT)
    src, _ = patch(job, {6: to(z=950)}, OWN)
    assert "LIN {X 1200,Y 0,Z 950,A 0,B 0,C 180}\r\n" in src
    assert src.replace("{X 1200,Y 0,Z 950,A 0,B 0,C 180}", "XP2:{X 0,Y 0,Z -40,A 0,B 0,C 0}") == SRC


def test_a_datum_that_an_expression_reads_is_not_changed_behind_its_back(job: Program) -> None:
    with pytest.raises(FlybyError, match="another target"):
        KUKA.patch(changed(job, {2: to(x=1210)}), ROBOT)
    src, dat = patch(job, {2: to(x=1210)}, OWN)
    assert dat == DAT and "  LIN {X 1210,Y 0,Z 900,A 0,B 0,C 180} C_DIS ;weiter" in src


def test_a_stop_becomes_a_fly_by_point(job: Program) -> None:
    src, _ = patch(job, {3: ball(7.5)})
    assert src == SRC.replace(
        "  LIN XP3\r\n", "  $APO.CDIS=7.5\r\n  LIN XP3 C_DIS\r\n  $APO.CDIS=10\r\n"
    )
    src, _ = patch(job, {0: zoned(ContourFraction(0.4))})
    assert src == SRC.replace("PTP XHOME\r\n", "$APO.CPTP=40\r\nPTP XHOME C_PTP\r\n")


def test_a_fly_by_point_becomes_a_stop(job: Program) -> None:
    src, _ = patch(job, {2: zoned(FINE), 5: zoned(FINE)})
    expected = SRC.replace("LIN XP2 C_DIS ;", "LIN XP2 ;").replace("XP5 C_DIS", "XP5")
    assert src == expected


def test_another_kind_of_approximation(job: Program) -> None:
    src, _ = patch(job, {4: zoned(Angle(math.radians(3)))})
    assert src == SRC.replace(
        "LIN {X 1250.5,Y 120,Z 905.25} C_DIS", "$APO.CORI=3\r\nLIN {X 1250.5,Y 120,Z 905.25} C_ORI"
    )


def test_other_changes_and_options_are_refused(job: Program) -> None:
    more = replace(job, statements=(*job.statements, Wait(1.0)))
    with pytest.raises(InputError, match="other statements"):
        KUKA.patch(more, ROBOT)
    with pytest.raises(InputError, match="unknown option"):
        KUKA.patch(job, ROBOT, {"opaque": "keep"})
    with pytest.raises(InputError, match="refuse, own"):
        KUKA.patch(job, ROBOT, {"shared": "yes"})
    tool = replace(job.moves[0].tool, tcp=replace(job.moves[0].tool.tcp, position=(0, 0, 0.1)))
    with pytest.raises(FlybyError, match=r"move 1: its tool has changed"):
        KUKA.patch(changed(job, {0: lambda m: replace(m, tool=tool)}), ROBOT)
    with pytest.raises(InputError, match="was not read"):
        KUKA.patch(replace(job, reading=None), ROBOT)


@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_any_change_is_patched_or_refused(job: Program, data: st.DataObject) -> None:
    """All zones and TCP speeds at once, each move its own."""
    sizes = st.floats(0.5, 40).map(lambda mm: round(mm, data.draw(st.integers(0, 6))))
    speeds = st.floats(0.01, 2.0)
    changes: dict[int, Change] = {}
    for index in (2, 3, 4, 5, 6):
        what = data.draw(st.sampled_from(["zone", "stop", "speed", "both", "nothing"]))
        zone, speed = ball(data.draw(sizes)), paced(tcp=data.draw(speeds))
        if what == "stop":
            changes[index] = zoned(FINE)
        elif what != "nothing":
            steps = {"zone": [zone], "speed": [speed], "both": [zone, speed]}[what]
            changes[index] = _in_turn(steps)
    src, dat = patch(job, changes, OWN)
    assert dat == DAT
    kept = [line for line in src.split("\r\n") if "$APO.CDIS=" not in line]
    kept = [line.replace(" C_DIS", "") for line in kept if "$VEL.CP=" not in line]
    before = [line for line in SRC.split("\r\n") if "$APO.CDIS=" not in line]
    before = [line.replace(" C_DIS", "") for line in before if "$VEL.CP=" not in line]
    assert kept == before


def _in_turn(steps: list[Change]) -> Change:
    def change(move: Move) -> Move:
        for step in steps:
            move = step(move)
        return move

    return change


# Inline forms

OLD_FORM = """DEF form( )
BAS (#INITMOV,0 )
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
;FOLD PTP P1 CONT Vel= 80 % PDAT1 Tool[1] Base[0];%{PE}%R 5.5.33,%MKUKATPBASIS,%CMOVE,\
%VPTP,%P 1:PTP, 2:P1, 3:C_PTP, 5:80, 7:PDAT1
$BWDSTART=FALSE
PDAT_ACT=PPDAT1
FDAT_ACT=FP1
BAS(#PTP_PARAMS,80)
PTP XP1 C_PTP
;ENDFOLD
;FOLD LIN P2  Vel= 0.5 m/s CPDAT2 Tool[1] Base[0];%{PE}%R 5.5.33,%MKUKATPBASIS,%CMOVE,\
%VLIN,%P 1:LIN, 2:P2, 3:, 5:0.5, 7:CPDAT2
$BWDSTART=FALSE
LDAT_ACT=LCPDAT2
FDAT_ACT=FP2
BAS(#CP_PARAMS,0.5)
LIN XP2
;ENDFOLD
END
"""
OLD_DATA = """DEFDAT form
DECL E6POS XP1={X 1200.0,Y -100.0,Z 1000.0,A 0.0,B 0.0,C 180.0,S 2,T 34,E1 0.0}
DECL FDAT FP1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE}
DECL PDAT PPDAT1={VEL 100.0,ACC 100.0,APO_DIST 100.0}
DECL E6POS XP2={X 1200.0,Y 0.0,Z 900.0,A 0.0,B 0.0,C 180.0,S 2,T 35,E1 0.0}
DECL FDAT FP2={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE}
DECL LDAT LCPDAT2={VEL 2.0,ACC 100.0,APO_DIST 20.0,APO_FAC 50.0,ORI_TYP #VAR}
ENDDAT
"""
NEW_FORM = """DEF form( )
BAS (#INITMOV,0 )
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
;FOLD SPTP P1 CONT Vel=80 % PDAT1 Tool[1] Base[0] ;%{PE}
;FOLD Parameters ;%{h}
;Params IlfProvider=kukaroboter.basistech.inlineforms.movement.spline; \
Kuka.BlendingEnabled=True; Kuka.VelocityPtp=80; IlfCommand=SPTP
;ENDFOLD
SPTP XP1 WITH $VEL_AXIS[1] = SVEL_JOINT(80.0), \
$TOOL = STOOL2(FP1), \
$BASE = SBASE(FP1.BASE_NO), $ACC_AXIS[1] = SACC_JOINT(PPDAT1), $APO = SAPO_PTP(PPDAT1) C_SPL
;ENDFOLD
;FOLD LIN P2 Vel=0.5 m/s CPDAT2 Tool[1] Base[0] ;%{PE}
;FOLD Parameters ;%{h}
;Params IlfProvider=kukaroboter.basistech.inlineforms.movement.old; \
Kuka.BlendingEnabled=False; Kuka.VelocityPath=0.5; IlfCommand=LIN
;ENDFOLD
$BWDSTART = FALSE
LDAT_ACT = LCPDAT2
FDAT_ACT = FP2
BAS(#CP_PARAMS, 0.5)
LIN XP2
;ENDFOLD
END
"""
NEW_DATA = OLD_DATA.replace("APO_DIST 100.0}", "APO_DIST 100.0,APO_MODE #CDIS}")


def forms(folder: Path, src: str, dat: str) -> Program:
    (folder / "form.src").write_text(src, "utf-8", newline="")
    (folder / "form.dat").write_text(dat, "utf-8", newline="")
    return KUKA.read_file(folder / "form.src", robot=ROBOT)


def test_an_older_form_follows_its_statements(tmp_path: Path) -> None:
    program = forms(tmp_path, OLD_FORM, OLD_DATA)
    src, dat = patch(program, {1: paced(joint_fraction=0.6), 2: paced(tcp=0.35)})
    speeds = (("Vel= 80 %", "Vel= 60 %"), ("5:80,", "5:60,"), ("PARAMS,80", "PARAMS,60"))
    speeds += (("Vel= 0.5 m", "Vel= 0.35 m"), ("5:0.5,", "5:0.35,"), ("PARAMS,0.5", "PARAMS,0.35"))
    assert (src, dat) == (_all_replaced(OLD_FORM, speeds), OLD_DATA)

    src, dat = patch(program, {1: zoned(ContourFraction(0.25))})
    assert (src, dat) == (OLD_FORM, OLD_DATA.replace("APO_DIST 100.0", "APO_DIST 25"))

    src, dat = patch(program, {1: zoned(FINE), 2: ball(15)})
    words = (("P1 CONT Vel", "P1 Vel"), ("3:C_PTP,", "3:,"), ("XP1 C_PTP", "XP1"))
    words += (("P2  Vel", "P2 CONT Vel"), ("2:P2, 3:,", "2:P2, 3:C_DIS,"), ("XP2\n", "XP2 C_DIS\n"))
    assert src == _all_replaced(OLD_FORM, words)
    assert dat == OLD_DATA.replace("APO_DIST 20.0", "APO_DIST 15")


def test_a_newer_form_follows_its_statements(tmp_path: Path) -> None:
    program = forms(tmp_path, NEW_FORM, NEW_DATA)
    src, _ = patch(program, {1: paced(joint_fraction=0.6), 2: paced(tcp=0.35)})
    speeds = (("Vel=80 %", "Vel=60 %"), ("VelocityPtp=80;", "VelocityPtp=60;"), ("(80.0)", "(60)"))
    speeds += (
        ("Vel=0.5 m", "Vel=0.35 m"),
        ("Path=0.5;", "Path=0.35;"),
        ("ARAMS, 0.5", "ARAMS, 0.35"),
    )
    assert src == _all_replaced(NEW_FORM, speeds)

    src, dat = patch(program, {1: zoned(FINE), 2: ball(15)})
    words = (("P1 CONT Vel", "P1 Vel"), ("Enabled=True", "Enabled="), (" C_SPL", ""))
    words += (("P2 Vel", "P2 CONT Vel"), ("Enabled=False", "Enabled=True"))
    words += (("Enabled=;", "Enabled=False;"), ("XP2\n", "XP2 C_DIS C_DIS\n"))
    assert src == _all_replaced(NEW_FORM, words)
    assert dat == NEW_DATA.replace("APO_DIST 20.0", "APO_DIST 15")


def _all_replaced(text: str, pairs: tuple[tuple[str, str], ...]) -> str:
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def test_a_point_of_a_form_gets_no_aggregate(tmp_path: Path) -> None:
    twice = OLD_FORM.replace("LIN XP2\n", "LIN XP2\n;ENDFOLD\n;FOLD again\nLIN XP2\n")
    program = forms(tmp_path, twice, OLD_DATA)
    with pytest.raises(FlybyError, match="inline form"):
        KUKA.patch(changed(program, {2: to(x=1210)}), ROBOT, OWN)
