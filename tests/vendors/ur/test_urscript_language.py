"""Values, operators, functions and scopes of URScript, told from where a move goes."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import SourceError
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.run.reader import read
from flyby.vendors.ur.values.poses import (
    interpolate_pose,
    pose_add,
    pose_inv,
    pose_of,
    pose_sub,
    pose_trans,
    quaternion_of,
    rotvec2rpy,
    rpy2rotvec,
    value_of,
)
from flyby.vendors.ur.values.values import UrPose


def value(expression: str, before: str = "") -> float:
    """An expression's value, as the first joint of a move."""
    (move,) = read(f"{before}\nmovej([{expression}, 0, 0, 0, 0, 0])", "t.script").moves
    assert isinstance(move.target, JointTarget)
    return move.target.joints[0]


def values(expression: str, before: str = "") -> tuple[float, ...]:
    """A list of six or a pose, as the target of a move."""
    (move,) = read(f"{before}\nmovej({expression})", "t.script").moves
    if isinstance(move.target, JointTarget):
        return move.target.joints
    assert isinstance(move.target, PoseTarget)
    pose = value_of(move.target.pose)
    return tuple(float(x) for x in pose if isinstance(x, int | float))


def refusal(text: str) -> str:
    with pytest.raises(SourceError) as caught:
        read(text, "t.script")
    return str(caught.value)


# --------------------------------------------------------------------- arithmetic


@pytest.mark.parametrize(
    ("expression", "result"),
    [
        ("1 + 2 * 3 - 4", 3),
        ("(1 + 2) * 3", 9),
        ("7 / 2", 3.5),
        ("7 % 4", 3),
        ("-7 % 4", -3),
        ("2 - -3", 5),
        ("- 0.5 + .25", -0.25),
        ("1e-3 + 0x10 + 0b11", 19.001),
        ("-(2) * -1", 2),
        ("d2r(180)", math.pi),
        ("r2d(3.141592653589793)", 180),
        (
            "sqrt(2) * sin(0.3) + cos(0.3) - tan(0.1)",
            math.sqrt(2) * math.sin(0.3) + math.cos(0.3) - math.tan(0.1),
        ),
        (
            "atan2(1, -1) + asin(0.5) + acos(0.5) + atan(1)",
            math.atan2(1, -1) + math.asin(0.5) + math.acos(0.5) + math.atan(1),
        ),
        ("pow(2, 0.5) + log(10, 1000)", math.sqrt(2) + 3),
        ("ceil(1.2) + floor(-1.2)", 0),
        ("norm([3, 4]) + norm(-2)", 7),
        ("length([1, 2, 3]) + get_list_length([1])", 4),
        ("6 & 3 | 8", 10),
        ("5 ^ 1 + (1 << 3)", 12),
        ("binary_list_to_integer([True, False, True])", 5),
        ('to_num("1.5") + str_len("abc") + str_find("hello", "l")', 6.5),
        ('to_num(str_cat("1", str_sub("x23", 1, 2)))', 123),
        ("[[1, 2], [3, 4]][1][0] + [[1, 2], [3, 4]][0, 1]", 5),
        ("([[1, 2], [3, 4]] * [1, 1])[1]", 7),
        ("inv([[2, 0], [0, 4]])[1][1]", 0.25),
        ("transpose([[1, 2], [3, 4]])[0][1]", 3),
        ("([1, 2] * 3 + [1, 1])[1]", 7),
        ("size([[1, 2, 3], [4, 5, 6]])[1]", 3),
        ("point_dist(p[0,0,0,0,0,0], p[3,4,0,1,0,0])", 5),
    ],
)
def test_expressions(expression: str, result: float) -> None:
    assert value(expression) == pytest.approx(result, abs=1e-12)


@pytest.mark.parametrize(
    ("condition", "fulfilled"),
    [
        ("1 == 1.0", True),
        ("[1, 2] == [1, 2]", True),
        ('"a" != "b"', True),
        ("not 1 > 2 and True", True),
        ("True xor True", False),
        ("False or not False", True),
        ("1 <= 1 and 2 >= 3", False),
        ("False and undeclared", False),
        ("True or undeclared", True),
        ("(1 == 2) == False", True),
        ("None == None", True),
        ("p[0,0,0,0,0,0] == p[0,0,0,0,0,1]", False),
    ],
)
def test_conditions(condition: str, fulfilled: bool) -> None:
    assert value("x", f"if {condition}:\n  x = 1\nelse:\n  x = 0\nend") == fulfilled


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.sampled_from(["+", "-", "*"]))
def test_arithmetic_is_that_of_doubles(a: float, b: float, symbol: str) -> None:
    expected = {"+": a + b, "-": a - b, "*": a * b}[symbol]
    assert value(f"({a!r}) {symbol} ({b!r})") == expected


# -------------------------------------------------------------------------- poses

poses = st.builds(
    lambda p, v: UrPose(*p, *v),
    st.tuples(*[st.floats(-2, 2)] * 3),
    st.tuples(*[st.floats(-1.7, 1.7)] * 3),
)


def same(one: object, other: object) -> bool:
    first, second = pose_of(one, "one"), pose_of(other, "other")  # type: ignore[arg-type]
    return bool(abs(first.matrix() - second.matrix()).max() < 1e-9)


@given(poses, poses)
def test_pose_functions_undo_each_other(one: UrPose, other: UrPose) -> None:
    assert same(pose_trans(pose_inv(one), pose_trans(one, other)), other)
    assert same(pose_sub(pose_add(one, other), other), one)
    assert same(interpolate_pose(one, other, 0), one)
    assert same(interpolate_pose(one, other, 1), other)


@given(st.tuples(st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(-3, 3)))
def test_roll_pitch_yaw_come_back(rpy: tuple[float, float, float]) -> None:
    again = rotvec2rpy(rpy2rotvec(rpy))
    assert isinstance(again, tuple)
    assert again == pytest.approx(rpy, abs=1e-8)


def test_roll_pitch_yaw_turn_about_fixed_axes() -> None:
    turn = Pose(quaternion=quaternion_of(*rpy2rotvec((0.3, 0.2, 0.1)))).matrix()  # type: ignore[misc]
    fixed = Pose(quaternion=quaternion_of(0, 0, 0.1))
    fixed = fixed @ Pose(quaternion=quaternion_of(0, 0.2, 0))
    fixed = fixed @ Pose(quaternion=quaternion_of(0.3, 0, 0))
    assert turn == pytest.approx(fixed.matrix(), abs=1e-12)


def test_pose_trans_chains_frames() -> None:
    got = values("pose_trans(p[1, 0, 0, 0, 0, 1.5707963267948966], p[1, 0, 0, 0, 0, 0])")
    assert got == pytest.approx((1, 1, 0, 0, 0, math.pi / 2))


# ------------------------------------------------------------- variables and scopes

FACTORIAL = """def fact(n):
  if n < 2:
    return 1
  end
  return n * fact(n - 1)
end
x = fact(6)"""
SKIPPING = """i = 0
x = 0
while i < 5:
  i = i + 1
  if i == 2:
    continue
  end
  if i == 4:
    break
  end
  x = x + i
end"""


@pytest.mark.parametrize(
    ("before", "result"),
    [
        ("a = 0\ndef f():\n  a = 1\nend\nf()\nx = a", 1),
        ("a = 0\ndef f():\n  local a = 1\nend\nf()\nx = a", 0),
        ("def f():\n  global a = 1\nend\nf()\nx = a", 1),
        ("def f(a, b=2):\n  return a * 10 + b\nend\nx = f(1)", 12),
        ("def f(a, b=2):\n  return a * 10 + b\nend\nx = f(b=3, a=4)", 43),
        ("def f(l):\n  l[0] = 9\nend\nk = [1]\nf(k)\nx = k[0]", 1),
        ("def f():\n  def g():\n    return 3\n  end\n  return g() + 1\nend\nx = f()", 4),
        (FACTORIAL, 720),
        ("s = struct(a=1, b=[2, 3])\ns.a = 5\ns.b[1] = 7\nx = s.a + s.b[1] + s[0]", 17),
        ("m = [[1, 2], [3, 4]]\nm[1][0] = 9\nm[0, 1] = 8\nx = m[1][0] + m[0][1]", 17),
        ("q = p[1, 2, 3, 0, 0, 0]\nq[2] = q[0]\nx = q[2]", 1),
        ("l = make_list(2, 5)\nl.append(7)\nl.insert(0, 1)\nx = l[3] + l.length()", 11),
        ("l = [3, 4]\nl.extend([5])\nl.remove(0)\nx = l.pop() + l[0]", 9),
        (SKIPPING, 4),
        ("x = 1; y = 2\nif y == 2: x = x + y end", 3),
        ("x = (1 +\n  2)", 3),
        ("x = 1 + \\\n 2", 3),
        ("if 1 > 2:\nx = 1\nelif 2 > 1:\nx = 2\nelse:\nx = 3\nend", 2),
        ("p = [4, 5]\nx = p[1]", 5),
        ("l = integer_to_binary_list(5)\nx = 0\nif l[2] and not l[1]:\n  x = 1\nend", 1),
    ],
)
def test_statements(before: str, result: float) -> None:
    assert value("x", before) == result


def test_markers_comments_and_names_of_any_alphabet() -> None:
    before = (
        '# Größe\n$ 1 "Programme du robot" "noBreak"\n  $ 2 "höhe≔0.5"\n'
        "höhe = 0.5 # m\nu54252_1 = 1.5\ntext = '$ no # marker'"
    )
    assert value("höhe + u54252_1 + str_len(text)", before) == 15


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
def test_ends_of_line_of_all_systems(ending: str) -> None:
    text = ending.join(["def prog():", "  a = 1", "  movej([a, 0, 0, 0, 0, 0])", "end", ""])
    (move,) = read(text, "t.script").moves
    assert move.origin is not None
    assert (move.origin.statement.line, move.origin.statement.column) == (3, 3)


# -------------------------------------------------------------------------- faults


@pytest.mark.parametrize(
    ("text", "place", "complaint"),
    [
        ("x = 1 / 0", "1:5", "division by zero"),
        ("x = 1 % 0", "1:5", "division by zero"),
        ("x = [1, 2][2]", "1:5", "has elements 0 to 1, and none 2"),
        ("x = [1, 2][0.5]", "1:5", "an index is a whole number"),
        ("x = 1\nx[0] = 2", "2:1", "only lists, poses and structs have elements"),
        ("s = struct(a=1)\nx = s.b", "2:5", "there is no part 'b' in a struct, which has a"),
        ('x = "a" * 2', "1:5", "'*' does not go with"),
        ("x = p[0,0,0,0,0,0] + p[0,0,0,0,0,0]", "1:5", "use pose_trans or pose_add"),
        ("if 'a':\nend", "1:4", "True or False is wanted"),
        ("x = sqrt(-1)", "1:5", "sqrt(-1) has no finite value"),
        ("x = pow(10, 1000)", "1:5", "no finite value"),
        ("def f(a):\nend\nf()", "3:1", "f needs the argument 'a'"),
        ("def f(a):\nend\nf(1, 2)", "3:6", "f takes 1 argument, not 2"),
        ("def f():\n  f()\nend\nf()", "2:3", "40 routines have called each other"),
        ("x = inv([[1, 1], [1, 1]])", "1:5", "the matrix has no inverse"),
        ("x = [[1, 2], [3, 4]] * [1, 2, 3]", "1:5", "sizes of the matrices"),
        ('x = to_num("abc")', "1:5", '"abc" is no number'),
        (
            "x = [1]\nwhile True:\n  x = [x]\nif x == 1:\nbreak\nend\nend",
            "3:7",
            "lists inside each other",
        ),
        ('x = "ab"\nwhile length(x) > 0:\n  x = str_cat(x, x)\nend', "3:7", "longer than"),
        ("x = 2\nwhile x > 0:\n  x = x * x\nend", "3:7", "too large"),
        ("x = [1].nothing(2)", "1:5", "has no method 'nothing'"),
        ("x = [1].append()", "1:5", "'append' does not take 0 arguments"),
    ],
)
def test_what_cannot_be_computed_is_named_with_its_place(
    text: str, place: str, complaint: str
) -> None:
    message = refusal(text)
    assert message.startswith(f"t.script:{place}: ")
    assert complaint in message
