"""Where a move's numbers stand in the text, and who else reads them."""

from __future__ import annotations

from flyby.core.program.origin import Ownership

DATA = """DECL E6POS XP1={X 100.5,Y 20,Z 30,A 10,B 20,C 30,S 2,T 35,E1 0.0}
DECL E6POS XP2={X 200,Y 0,Z 30,A 10,B 20,C 30}
DECL PDAT PPDAT1={VEL 70.0,ACC 60.0,APO_DIST 25.0}
DECL LDAT LCPDAT1={VEL 1.5,ACC 100.0,APO_DIST 15.0}
DECL FDAT FP1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE}
DECL E6POS h
"""
INIT = "BAS(#INITMOV,0)\n"


def texts(program, numbers):
    files = program.reading.files
    return [None if n is None else files[n.file].text[n.start : n.end] for n in numbers]


def test_target_in_the_data_list(krl):
    program = krl(INIT + "LIN XP1", DATA)
    target = program.moves[0].origin.target
    assert target.ownership is Ownership.OWNED and target.datum == "XP1"
    assert texts(program, target.numbers) == [
        "100.5",
        "20",
        "30",
        "10",
        "20",
        "30",
        "2",
        "35",
        "0.0",
        None,
        None,
        None,
        None,
        None,
    ]
    assert target.span.file == "demo.src"


def test_target_at_the_motion(krl):
    program = krl(INIT + "PTP {A1 0,A2 -90.5,A3 90,A4 0,A5 0,A6 - 5}")
    target = program.moves[0].origin.target
    assert target.ownership is Ownership.OWNED and target.datum is None
    assert texts(program, target.numbers)[:6] == ["0", "-90.5", "90", "0", "0", "- 5"]
    assert len(target.numbers) == 12


def test_shared_targets(krl):
    program = krl(INIT + "LIN XP1\nLIN XP2\nLIN XP1", DATA)
    kinds = [m.origin.target.ownership for m in program.moves]
    assert kinds == [Ownership.SHARED, Ownership.OWNED, Ownership.SHARED]
    program = krl(INIT + "FOR SUCCESS=1 TO 2\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nENDFOR", DATA)
    assert program.moves[0].origin.target.ownership is Ownership.SHARED


def test_a_copy_keeps_the_literal_and_a_sum_does_not(krl):
    program = krl(INIT + "h=XP2\nh.Z=XP2.Z+50\nLIN h\nLIN XP1", DATA)
    first, second = (m.origin.target for m in program.moves)
    assert texts(program, first.numbers) == ["200", "0", None, "10", "20", "30", *[None] * 8]
    assert first.ownership is Ownership.OWNED
    assert second.ownership is Ownership.OWNED
    program = krl(INIT + "h=XP2\nh.Z=XP2.Z+50\nLIN h\nLIN XP2", DATA)
    assert [m.origin.target.ownership for m in program.moves] == [Ownership.SHARED] * 2


def test_derived_targets(krl):
    program = krl(INIT + "LIN XP2\nLIN_REL {X 10}\nLIN XP1:{X 5}", DATA)
    first, second, third = (m.origin.target for m in program.moves)
    assert first.ownership is Ownership.SHARED  # the second goes on from it
    assert second.ownership is Ownership.DERIVED and second.numbers == ()
    assert third.ownership is Ownership.DERIVED


def test_what_is_filled_in_is_nobody_s(krl):
    program = krl(INIT + "LIN XP2\nLIN {Z 80}", DATA)
    first, second = (m.origin.target for m in program.moves)
    assert texts(program, second.numbers) == [None, None, "80", *[None] * 11]
    assert first.ownership is Ownership.SHARED and second.ownership is Ownership.OWNED


def test_ptp_speed(krl):
    program = krl(INIT + "BAS(#VEL_PTP,50)\n$ACC_AXIS[2]=33\nPTP XP1", DATA)
    speed = program.moves[0].origin.speed
    assert texts(program, speed.numbers) == ["50"] * 6 + [None, "33", *[None] * 4]
    assert speed.ownership is Ownership.OWNED


def test_speed_and_zone_of_a_form(krl):
    body = (
        "PDAT_ACT=PPDAT1\nFDAT_ACT=FP1\nBAS(#PTP_PARAMS,30)\nPTP XP1 C_PTP\n"
        "LDAT_ACT=LCPDAT1\nBAS(#CP_PARAMS,0.4)\nLIN XP2 C_DIS"
    )
    program = krl(INIT + body, DATA)
    joint, line = program.moves
    assert texts(program, joint.origin.speed.numbers) == ["30"] * 6 + ["60.0"] * 6
    assert texts(program, joint.origin.zone.numbers) == ["25.0"]
    assert joint.origin.zone.datum == "PPDAT1.APO_DIST"
    assert texts(program, line.origin.speed.numbers) == ["0.4", *[None] * 5]
    assert texts(program, line.origin.zone.numbers) == ["15.0"]
    assert line.origin.zone.ownership is Ownership.OWNED
    zone = line.origin.zone.span
    assert program.reading.files["demo.src"].text[zone.start : zone.end] == "C_DIS"


def test_path_speed(krl):
    program = krl(INIT + "$VEL={CP 0.5,ORI1 90,ORI2 80}\n$ACC.CP=3\nLIN XP1\nLIN XP2", DATA)
    speed = program.moves[0].origin.speed
    assert texts(program, speed.numbers) == ["0.5", "90", "80", "3", None, None]
    assert speed.ownership is Ownership.SHARED


def test_scaled_speeds_are_derived(krl):
    program = krl(INIT + "$VEL.CP=0.5\n$OV_PRO=50\nLIN XP1", DATA)
    assert program.moves[0].origin.speed.ownership is Ownership.DERIVED


def test_a_stop_point_says_where_approximation_would_stand(krl):
    program = krl(INIT + "LIN XP1 ; down", DATA)
    zone = program.moves[0].origin.zone
    assert zone.ownership is Ownership.DERIVED and zone.span.start == zone.span.end
    text = program.reading.files["demo.src"].text
    assert text[: zone.span.start].endswith("LIN XP1")


def test_shipped_data_have_no_place(krl):
    program = krl(INIT + "PTP XHOME\nLIN XP1 C_DIS", DATA)
    home, line = (m.origin for m in program.moves)
    assert home.target.ownership is Ownership.SHARED
    assert home.target.datum == "XHOME" and home.target.numbers == ()
    assert line.speed.numbers == () and line.zone.numbers == ()


def test_arcs_have_an_origin_of_the_auxiliary_point(krl):
    program = krl(INIT + "CIRC XP1,XP2", DATA)
    origin = program.moves[0].origin
    assert origin.via.datum == "XP1" and origin.target.datum == "XP2"
    assert origin.via.ownership is Ownership.OWNED


def test_reading_again_gives_the_changed_number(krl):
    program = krl(INIT + "LIN XP1", DATA)
    file = program.reading.files["demo.dat"]
    span = program.moves[0].origin.target.numbers[0]
    text = file.text[: span.start] + "111" + file.text[span.end :]
    changed = program.reading.again({"demo.dat": type(file)("demo.dat", text)})
    assert changed.moves[0].target.pose.position[0] == 0.111
