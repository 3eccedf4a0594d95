"""Programs for palletisers: driven, and what the arm cannot do is refused with its cause."""

from __future__ import annotations

import numpy as np
import pytest

import flyby
from flyby.core.errors import FaultCause, InputError

RAPID = """MODULE Pal
  PERS tooldata tGrip:=[TRUE,[[0,0,350],[1,0,0,0]],[35,[0,0,150],[1,0,0,0],0,0,0]];
  CONST jointtarget home:=[[0,0,20,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pick:=[[1800,900,300],[0,0.7071,0.7071,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget put:=[[1800,-500,100],[0,1,0,0],[-1,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ home,v2000,fine,tGrip;
    FOR i FROM 0 TO 2 DO
      MoveJ Offs(pick,0,0,400),v2000,z200,tGrip;
      MoveL pick,v500,fine,tGrip;
      MoveL Offs(pick,0,0,400),v1000,z100,tGrip;
      MoveJ Offs(put,i*200,0,600),v2000,z200,tGrip;
      MoveL Offs(put,i*200,0,i*100),v500,fine,tGrip;
      MoveL Offs(put,i*200,0,600),v1000,z100,tGrip;
    ENDFOR
    MoveAbsJ home,v2000,fine,tGrip;
  ENDPROC
ENDMODULE
"""
KRL = """DEF pal()
DECL E6AXIS XHOME
BAS(#INITMOV,0)
XHOME={A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}
$TOOL={X 0,Y 0,Z 300,A 0,B 0,C 0}
$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}
$VEL.CP=1.5
PTP XHOME
PTP {X 1900,Y 800,Z 600,A 0,B 0,C 180}
LIN {X 1900,Y 800,Z 200,A 0,B 0,C 180} C_DIS
LIN {X 1900,Y 800,Z 600,A 0,B 0,C 180} C_DIS
PTP {X 1900,Y -800,Z 600,A 45,B 0,C 180}
LIN_REL {Z -400}
PTP XHOME
END
"""


def driven(tmp_path, text: str, suffix: str, robot: str):
    path = tmp_path / f"pal{suffix}"
    path.write_text(text, "utf-8")
    return flyby.emulate(flyby.read(path, robot=robot))


@pytest.mark.parametrize("robot", ["IRB 660-180/3.15", "IRB 760", "IRB 460"])
def test_rapid_is_driven_level(tmp_path, robot) -> None:
    text = RAPID if robot != "IRB 460" else RAPID.replace("1800", "1400")
    run = driven(tmp_path, text, ".mod", robot)
    assert run.faultless, run.notes
    assert np.abs(run.trajectory.q[:, 3:5]).max() < 1e-9
    R, _ = run.robot.forward(run.trajectory.q)
    np.testing.assert_allclose(R[:, 2, 2], -1.0, atol=1e-12)


@pytest.mark.parametrize(
    "robot",
    ["KR 120 R3200 PA", "KR 180-2 PA", "KR 700 PA", "KR140R3200_2PA", "KR 1000 L1300 titan PA"],
)
def test_krl_is_driven_level(tmp_path, robot) -> None:
    run = driven(tmp_path, KRL, ".src", robot)
    assert run.faultless, run.notes
    q = run.trajectory.q
    assert np.abs(q[:, 3]).max() < 1e-9
    np.testing.assert_allclose(q[:, 1] + q[:, 2] + q[:, 4], np.pi / 2, atol=1e-9)


def test_an_orientation_out_of_its_power_is_a_fault(tmp_path) -> None:
    tilted = RAPID.replace("[0,1,0,0],[-1", "[0,0.9962,0,0.0872],[-1")
    run = driven(tmp_path, tilted, ".mod", "IRB 660-180/3.15")
    causes = [fault.cause for fault in run.faults]
    assert len(causes) == 9 and set(causes) == {FaultCause.REACH}
    assert "the pose is 10.01° away" in str(run.faults[0].message)
    run = driven(tmp_path, KRL.replace("A 45,B 0", "A 45,B 5"), ".src", "KR 120 R3200 PA")
    assert [fault.cause for fault in run.faults][:1] == [FaultCause.REACH]


def test_a_line_that_would_tilt_is_a_fault(tmp_path) -> None:
    tilted = KRL.replace("Z 200,A 0,B 0,C 180", "Z 200,A 0,B 0,C 170")
    run = driven(tmp_path, tilted, ".src", "KR 120 R3200 PA")
    assert any("no motor" in str(fault.message) for fault in run.faults)


def test_axes_without_a_motor_stand_at_zero(tmp_path) -> None:
    run = driven(tmp_path, RAPID.replace("[0,0,20,0,0,0]", "[0,0,20,15,0,0]"), ".mod", "IRB 760")
    assert any("J4" in str(fault.message) for fault in run.faults)


def test_a5_goes_where_the_controller_keeps_it(tmp_path) -> None:
    run = driven(tmp_path, KRL.replace("A5 90", "A5 0"), ".src", "KR 120 R3200 PA")
    assert run.faultless
    assert any("A5 goes to 90°, not 0°" in note.message for note in run.notes)


def test_zones_are_proven_and_written(tmp_path) -> None:
    path = tmp_path / "pal.mod"
    path.write_text(RAPID, "utf-8")
    found = flyby.zones(flyby.read(path, robot="IRB 660-180/3.15"))
    assert found.after.time < found.before.time
    assert found.certificate is not None and found.certificate.proven


def test_targets_of_arms_without_a_spherical_wrist_are_driven(tmp_path) -> None:
    """Of a CRB 15000's configuration the quadrants of axes 1, 4 and 6 count."""
    text = RAPID.replace("[0,0,20,0,0,0]", "[0,0,0,0,30,0]").split("    FOR")[0]
    text += (
        "    MoveJ [[500,200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n"
    )
    run = driven(tmp_path, f"{text}  ENDPROC\nENDMODULE\n", ".mod", "CRB 15000-5/0.95")
    assert run.faultless, run.faults


SCARA = """MODULE Pick
  CONST jointtarget home:=[[30,60,-20,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pick:=[[350,300,150],[0,1,0,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ home,v1000,fine,tool0;
    MoveJ Offs(pick,0,0,50),v2000,z10,tool0;
    MoveL pick,v500,fine,tool0;
    MoveL Offs(pick,0,0,50),v500,fine,tool0;
    MoveAbsJ home,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_a_scaras_third_axis_counts_in_mm(tmp_path) -> None:
    run = driven(tmp_path, SCARA, ".mod", "IRB 910SC-3/0.65")
    assert run.faultless, run.faults
    home, line = run.trajectory.q[-1], run.trajectory.move == 2
    np.testing.assert_allclose(home, [*np.radians([30, 60]), -0.02, 0, 0, 0], atol=1e-9)
    assert run.trajectory.q[line, 2].min() == pytest.approx(0.150 - 0.220, abs=1e-6)
    with pytest.raises(InputError, match="not written yet"):
        flyby.write(run.program, tmp_path / "new", robot=run.robot.name)


def test_a_scara_of_kuka_is_written_in_mm(tmp_path) -> None:
    text = KRL.replace("A2 -90,A3 90,A4 0,A5 90", "A2 60,A3 150,A4 0,A5 0")
    text = text.replace("Y 800", "Y 100").replace("X 1900", "X 400").replace("Y -800", "Y -200")
    text = (
        text.replace("Z 600", "Z 300").replace("Z -400", "Z -50").replace("Z 300,A 0", "Z 0,A 0", 1)
    )
    run = driven(tmp_path, text, ".src", "KR 10 scara R600 Z300")
    assert run.faultless, run.faults
    written = flyby.write(run.program, tmp_path / "new", robot=run.robot.name)
    assert any("A3 150" in file.read_text("utf-8") for file in written)
