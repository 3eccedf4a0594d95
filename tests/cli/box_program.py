"""A program that goes over a box in five joint moves, and its cell."""

from __future__ import annotations

REST = "[9E9,9E9,9E9,9E9,9E9,9E9]"
POINTS = ((-4.19, 69.06), (-21.07, 62.34), (-4.74, 42.65), (22.3, 18.62), (38.27, 11.47))
"""°, joints 2 and 3 of p0, p1, …; the others are zero."""
CELL = """robot = "abb/irb6640-180-255"
clearance_mm = 5
[tool.rod]
tcp = { xyz_mm = [0, 0, 300] }
capsule_mm = [50, 300]
pose = { xyz_mm = [0, 0, 150] }
[[obstacle]]
name = "box"
box_mm = [150, 1200, 830]
pose = { xyz_mm = [1575, 0, 415] }
[allow]
pairs = [["J2", "J4"]]
"""


def module(*moves: str) -> str:
    """A module that drives from p0 to p4 by these statements."""
    return "\r\n".join(
        (
            "MODULE m ! keep me",
            "  PERS tooldata rod:=[TRUE,[[0,0,300],[1,0,0,0]],[1,[0,0,100],[1,0,0,0],0,0,0]];",
            "  PERS zonedata zz:=[FALSE,30,45,45,4.5,45,4.5];",
            *(
                f"  CONST jointtarget p{k}:=[[0,{a},{b},0,0,0],{REST}];"
                for k, (a, b) in enumerate(POINTS)
            ),
            "  PROC main()",
            "    MoveAbsJ p0,v1000,fine,rod;",
            *(f"    {move}" for move in moves),
            "    MoveAbsJ p4,v1000,fine,rod;",
            "  ENDPROC",
            "ENDMODULE",
            "",
        )
    )
