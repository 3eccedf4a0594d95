"""Moves with events, searches, external axes alone, processes; displacement and offsets."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.program.event import Event, EventAnchor
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.origin import Ownership
from flyby.core.program.question import QuestionKind
from flyby.core.program.zone import FINE
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
P = f"[[500,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}]"
DATA = f"""
  CONST robtarget p:={P};
  CONST robtarget q:=[[400,50,600],[0,0,1,0],[0,0,0,0],{UNUSED}];
  CONST robtarget r:=[[300,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}];
  CONST jointtarget home:=[[0,10,20,0,30,0],{UNUSED}];
  CONST jointtarget away:=[[0,10,20,0,30,0],[1000,9E9,9E9,9E9,9E9,9E9]];
  PERS tooldata tGun:=[TRUE,[[0,0,200],[1,0,0,0]],[4,[0,0,50],[1,0,0,0],0,0,0]];
  VAR triggdata t1; VAR triggdata t2; VAR triggdata ts{{2}}; VAR robtarget found;
"""


def program(body, routines="", answers=None, **options):
    text = f"MODULE M\n{DATA}\nPROC main()\n{body}\nENDPROC\n{routines}\nENDMODULE"
    return read(text, "a.mod", ReadOptions(answers=answers or Answers()), **options)


def move(body, *args, **options):
    return program(body, *args, **options).moves[-1]


def refusal(body):
    with pytest.raises(SourceError) as caught:
        program(body)
    assert caught.value.span is not None
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "kind", "event"),
    [
        ("MoveLDO p,v100,z10,tool0,do1,1;", MoveL, "do1,1"),
        ("MoveJDO p,v100,z10,tool0\\WObj:=wobj0, do1, 0;", MoveJ, "do1,0"),
        ("MoveCDO p,q,v100,z10,tool0,doGlue,high;", MoveC, "doGlue,high"),
        ("MoveLAO p,v100,z10,tool0,ao1,5.2;", MoveL, "\\AOp:=ao1,5.2"),
        ("MoveJGO p,v100,z10,tool0,go1\\Value:=5;", MoveJ, "\\GOp:=go1,5"),
        ('MoveLSync p,v100,z10,tool0,"rGlue";', MoveL, '"rGlue"'),
    ],
)
def test_moves_that_set_outputs(text, kind, event):
    found = move(text)
    assert type(found) is kind
    assert found.events == (Event(event),)
    plain = move(
        text.replace("DO", "")
        .replace("AO", "")
        .replace("GO", "")
        .replace("Sync", "")
        .split(",tool0")[0]
        + ",tool0;"
    )
    assert found.target == plain.target and found.zone == plain.zone
    assert found.origin.target.ownership in (Ownership.OWNED, Ownership.SHARED)


@pytest.mark.parametrize(
    ("define", "event"),
    [
        ("TriggIO t1,10\\DOp:=do1,1;", Event("do1,1", distance=0.01)),
        ("TriggIO t1,10\\Start\\DOp:=do1,1;", Event("do1,1", EventAnchor.START, 0.01)),
        ("TriggIO t1,0.2\\Time\\GOp:=go1,n;", Event("\\GOp:=go1,n", time=0.2)),
        ("TriggEquip t1,5,0.1\\AOp:=ao1,3;", Event("\\AOp:=ao1,3", distance=0.005, time=0.1)),
        ("TriggEquip t1,0\\Start,0\\DOp:=do1,0;", Event("do1,0", EventAnchor.START)),
        ("TriggInt t1,5\\Time,iGun;", Event("TriggInt iGun", time=5)),
        ("TriggCheckIO t1,100,di1,EQ,1\\StopMove,iGun;", None),
        ("TriggRampAO t1,10,0.1,ao1,8,15;", Event("TriggRampAO ao1,8,15", distance=0.01, time=0.1)),
    ],
)
def test_trigger_data_become_events(define, event):
    if event is None:
        event = Event("TriggCheckIO di1,EQ,1,iGun", distance=0.1)
    body = f"{define}\nTriggL p,v100,t1,z10,tool0;"
    assert move(body).events == (event,)
    handed = "PROC go(VAR triggdata t)\nTriggJ p,v100,t,z10,tool0;\nENDPROC"
    assert move(f"{define}\ngo t1;", handed).events == (event,)


def test_moves_with_several_triggers():
    body = """
      TriggIO t1,1\\DOp:=do1,1;
      TriggIO t2,2\\DOp:=do2,1;
      ts{1} := t2;
      TriggIO ts{2},3\\DOp:=do3,1;
    """
    assert [e.text for e in move(f"{body}\nTriggL p,v100,t1\\T2:=t2,z10,tool0;").events] == [
        *("do1,1", "do2,1")
    ]
    arc = move(f"{body}\nTriggC p,q,v100,ts,fine,tGun\\WObj:=wobj0;")
    assert [e.text for e in arc.events] == ["do2,1", "do3,1"] and arc.zone is FINE
    assert move(f"{body}\nTriggAbsJ home,v100,t1,z10,tool0;").target.name == "home"
    unknown = program("TriggL p,v100,t1,z10,tool0;")
    assert unknown.moves[0].events == (Event("t1"),)
    assert "the trigger data t1 are not known" in str(unknown.notes)
    assert "TriggIO: a num is wanted" in refusal('TriggIO t1,"x"\\DOp:=do1,1;')
    assert "distance of 0 or more" in refusal("TriggIO t1,-1\\DOp:=do1,1;")


@given(
    st.floats(0, 5000, allow_subnormal=False),
    st.booleans(),
    st.booleans(),
    st.sampled_from(["DOp", "GOp", "AOp"]),
)
def test_distances_and_times_arrive_in_si_units(amount, start, time, signal):
    switches = ("\\Start" if start else "") + ("\\Time" if time else "")
    body = f"TriggIO t1,{amount!r}{switches}\\{signal}:=sig,1;\nTriggL p,v100,t1,z10,tool0;"
    (event,) = move(body).events
    assert event.anchor is (EventAnchor.START if start else EventAnchor.END)
    assert (event.distance, event.time) == pytest.approx(
        (0, amount) if time else (amount / 1000, 0)
    )


# --------------------------------------------------------------------- special moves


def test_a_search_ends_where_it_is_told_to():
    search = "SearchL\\Stop,diTouch\\PosFlank,found,p,v20,tGun\\WObj:=wobj0;"
    result = program(f"{search}\nMoveL Offs(found,0,0,50),v100,fine,tGun;")
    assert result.moves[0].target.name == "p" and result.moves[0].zone is FINE
    assert result.moves[1].target.pose.position == pytest.approx((0.5, 0, 0.65))
    assert "taken to find its point at its end" in str(result.notes)
    (asked,) = (q for q in result.questions if q.kind is QuestionKind.SENSOR)
    assert (asked.key, asked.type, asked.answered) == ("found", "robtarget", False)
    answer = Answers({"found": ((500.0, 0.0, 580.0), (0.0, 0.0, 1.0, 0.0), (0.0,) * 4, (9e9,) * 6)})
    result = program(f"{search}\nMoveL found,v100,fine,tGun;", answers=answer)
    assert [m.target.pose.position[2] for m in result.moves] == pytest.approx([0.58, 0.58])
    passing = program(search.replace("\\Stop", "\\Sup"), answers=answer)
    assert passing.moves[0].target.pose.position[2] == pytest.approx(0.6)
    arc = program("MoveL p,v100,fine,tGun;\nSearchC di1,found,q,r,v20,tGun;").moves[1]
    assert isinstance(arc, MoveC)


def test_what_a_search_finds_is_what_its_loop_asks():
    """The search writes it: the loop that asks for it does not wait for others."""
    data = "VAR robtarget pp:=[[500,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    loop = "WHILE pp.trans.z>580 DO\nSearchL\\Stop,di1,pp,Offs(pp,0,0,-50),v20,tGun;\nENDWHILE"
    assert len(program(loop, data).moves) == 3


def test_a_search_starts_from_what_its_point_held():
    """The point gets its value at the end: the arguments may be made of the one before."""
    data = "VAR robtarget pp:=[[500,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    search = "SearchL\\Stop,di1,pp,Offs(pp,0,0,-50),v20,tGun;"
    twice = f"{search}\n{search}\nMoveL Offs(pp,0,0,5),v100,fine,tGun;"
    heights = [round(1e3 * m.target.pose.position[2], 6) for m in program(twice, data).moves]
    assert heights == [650, 600, 605]
    point = ((500.0, 0.0, 580.0), (0.0, 0.0, 1.0, 0.0), (0.0,) * 4, (9e9,) * 6)
    answer = Answers({"pp": point})
    flying = f"{search.replace('Stop', 'Sup')}\nMoveL pp,v100,fine,tGun;"
    heights = [m.target.pose.position[2] for m in program(flying, data, answers=answer).moves]
    assert heights == pytest.approx([0.65, 0.58])
    arc = "MoveL p,v100,fine,tGun;\nSearchC\\Stop,di1,pp,Offs(pp,0,50,0),Offs(pp,50,50,0),v20,tGun;"
    driven = program(arc, data, answers=answer).moves[1]
    assert driven.via.pose.position == pytest.approx((0.5, 0.05, 0.7))
    assert driven.target.pose.position == pytest.approx((0.5, 0, 0.58))


def test_external_axes_alone():
    body = "MoveAbsJ home,v100,fine,tGun;\nMoveExtJ away,vmax,z50;"
    found = move(body, external_axes=("linear",))
    assert isinstance(found, MoveJ)
    assert found.target.joints == pytest.approx([math.radians(v) for v in (0, 10, 20, 0, 30, 0)])
    assert found.target.external == (1.0,) and found.tool.name == "tGun"
    assert found.origin.target.ownership is Ownership.DERIVED


@pytest.mark.parametrize(
    ("text", "kind", "event"),
    [
        ("ArcLStart p,v100,seam1,weld1,fine,tGun\\WObj:=wobj0;", MoveL, "ArcLStart seam1,weld1"),
        ("ArcL p,v100,seam1,weld1\\Weave:=weave1,z1,tGun;", MoveL, "ArcL seam1,weld1"),
        ("ArcCEnd p,q,v100,seam1,weld1,fine,tGun;", MoveC, "ArcCEnd seam1,weld1"),
        ("ArcL\\On,p,v100,sm1,wd1,wv1,fine,tGun;", MoveL, "ArcL sm1,wd1,wv1"),
        ("SpotL p,vmax,gun1,spot1,tGun;", MoveL, "SpotL gun1,spot1"),
        ("SpotJ p,vmax,gun1,spot1\\InPos,tGun\\WObj:=wobj0;", MoveJ, "SpotJ gun1,spot1"),
        ("DispL\\On,p,v100,bead1,z10,tGun;", MoveL, "DispL bead1"),
        ("PaintL p,v100,z10,tGun;", MoveL, "PaintL"),
        ("ArcMoveJ p,v100,z10,tGun;", MoveJ, "ArcMoveJ"),
    ],
)
def test_instructions_of_option_packages_are_moves(text, kind, event):
    result = program(text)
    assert type(result.moves[0]) is kind
    assert result.moves[0].events == (Event(event),)
    assert "process data" in str(result.notes)
    assert (result.moves[0].zone is FINE) == ("z1" not in text)


# ---------------------------------------------------------- displacement and offsets


def test_displacement_by_two_points():
    body = "PDispOn \\ExeP:=q,p,tool0;\nMoveL p,v100,fine,tool0;"
    assert move(body).target.pose.position == pytest.approx((0.4, 0.05, 0.6))
    turned = "PDispOn \\Rot\\ExeP:=RelTool(p,0,0,0\\Rz:=90),p,tool0;\nMoveL r,v100,fine,tool0;"
    # The point lies 200 mm beside p and turns with it.
    assert move(turned).target.pose.position == pytest.approx((0.5, 0.2, 0.6), abs=1e-9)
    present = "MoveL q,v100,fine,tGun;\nPDispOn p,tGun;\nMoveL p,v100,fine,tGun;"
    assert move(present).target.pose.position == pytest.approx((0.4, 0.05, 0.6))
    assert "present position" in refusal("MoveAbsJ home,v100,fine,tGun;\nPDispOn p,tGun;")
    off = f"{body}\nPDispOff;\nMoveL p,v100,fine,tool0;"
    assert move(off).target.name == "p"


def test_offsets_of_external_axes():
    shift = "EOffsSet [50,0,0,0,0,0];\n"
    axes = {"external_axes": ("linear",)}
    assert move(f"{shift}MoveAbsJ away,v100,fine,tool0;", **axes).target.external == (1.05,)
    assert move(f"{shift}MoveAbsJ away\\NoEOffs,v100,fine,tool0;", **axes).target.external == (1,)
    assert move(f"{shift}EOffsOff;\nMoveAbsJ away,v100,fine,tool0;", **axes).target.external == (1,)
    assert move(f"{shift}MoveL p,v100,fine,tool0;").target.external == ()
    points = "EOffsOn \\ExeP:=b,a;\nMoveAbsJ away,v100,fine,tool0;"
    data = "VAR robtarget a; VAR robtarget b;"
    body = f"a:=p; b:=p; a.extax.eax_a:=100; b.extax.eax_a:=130;\n{points}"
    text = f"MODULE M\n{DATA}{data}\nPROC main()\n{body}\nENDPROC\nENDMODULE"
    assert read(text, "a.mod", **axes).moves[0].target.external == pytest.approx((1.03,))
