"""Logs in the forms that controllers and their tools write."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, InputError
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.logs import load_columns, read_samples
from flyby.identification.logs.formats import FORMATS

T = np.array([0.0, 0.01, 0.02, 0.03])
Q = np.linspace(-0.5, 0.7, 24).reshape(4, 6)
HEADS = {
    "plain": ["t", *(f"q{k}" for k in range(1, 7))],
    "rtde": ["timestamp", *(f"actual_q_{k}" for k in range(6))],
    "rtde-target": ["timestamp", *(f"target_q_{k}" for k in range(6))],
    "cjointt": ["timestamp", *(f"J{k}" for k in range(1, 7))],
    "egm": ["TIMESTAMP", *(f"R_FB_POS_RJ{k}" for k in range(1, 7))],
    "rsi": ["IPOC", *(f"A{k}" for k in range(1, 7))],
    "trace": ["Zeit [s]", *(f"AxisPos_CmdIpo{k} [°]" for k in range(1, 7))],
}
IN_DEGREES = {"cjointt", "egm", "rsi", "trace"}
IN_MS = {"egm", "rsi"}


def text_of(head, t, q, delimiter=",") -> str:
    rows = [delimiter.join(f"{v:.12g}" for v in (a, *b)) for a, b in zip(t, q, strict=True)]
    return "\n".join([delimiter.join(head), *rows]) + "\n"


@pytest.fixture
def robot():
    return find_robot("kuka/kr3-r540")


def check(path: Path, robot, columns=None) -> None:
    samples = read_samples(path, robot, columns)
    np.testing.assert_allclose(samples.t, T, atol=1e-12)
    np.testing.assert_allclose(samples.q, Q, atol=1e-11)
    assert samples.notes == ()


@pytest.mark.parametrize("form", HEADS)
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_each_known_form_is_read(tmp_path, robot, form, delimiter) -> None:
    t = 1234.0 + (1e3 * T if form in IN_MS else T)
    q = np.degrees(Q) if form in IN_DEGREES else Q
    path = tmp_path / "log.txt"
    path.write_text(text_of(HEADS[form], t, q, delimiter), "utf-8")
    check(path, robot)


def test_every_form_has_a_case() -> None:
    assert set(FORMATS) == {form.removesuffix("-target") for form in HEADS}


def test_spaces_and_further_columns_as_rtde_recordings_have_them(tmp_path, robot) -> None:
    head = ["timestamp", *(f"target_q_{k}" for k in range(6)), *HEADS["rtde"][1:]]
    path = tmp_path / "robot_data.csv"
    path.write_text(text_of(head, T, np.hstack([0 * Q, Q]), " "), "utf-8")
    check(path, robot)


def test_latin_text_with_decimal_commas(tmp_path, robot) -> None:
    text = text_of(HEADS["trace"], T, np.degrees(Q), "\t").replace(".", ",")
    path = tmp_path / "trace.asc"
    path.write_bytes(text.replace("\n", "\r\n").encode("latin-1"))
    check(path, robot)


def spreadsheet(delimiter: str, quote: str = "") -> str:
    """As spreadsheets save tables where numbers have decimal commas."""
    rows = [HEADS["plain"], *([*map(str, row)] for row in np.column_stack([T, Q]))]
    cells = ([quote + cell.replace(".", ",") + quote for cell in row] for row in rows)
    return "".join(delimiter.join(row) + "\r\n" for row in cells)


@pytest.mark.parametrize(
    "text",
    [
        spreadsheet(";"),
        spreadsheet("\t"),
        spreadsheet(";", '"'),
        spreadsheet(",", '"'),
        "sep=;\r\n" + spreadsheet(";"),
        spreadsheet(";").replace("\r\n", ";;\r\n"),
    ],
    ids=["semicolons", "tabs", "quotes", "commas in quotes", "separator named", "empty cells"],
)
@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
def test_tables_of_spreadsheets(tmp_path, robot, text, encoding) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(text.encode(encoding))
    check(path, robot)


def test_commas_that_divide_and_are_decimal_are_refused(tmp_path, robot) -> None:
    path = tmp_path / "log.csv"
    path.write_text(spreadsheet(","), "utf-8")
    with pytest.raises(InputError, match=r"log\.csv:2: .* the header 7: with decimal commas, div"):
        read_samples(path, robot)


def test_a_line_that_breaks_off_is_left_out_and_said(tmp_path, robot) -> None:
    text = text_of(HEADS["plain"], [*T, 0.04], [*Q, Q[-1]])
    path = tmp_path / "log.csv"
    path.write_text(text[: text.rindex(",")][:-4].rsplit(",", 2)[0], "utf-8")
    samples = read_samples(path, robot)
    assert len(samples.t) == 4
    assert samples.notes == ("the last line breaks off and is left out",)


RSI = (
    '<Rob Type="KUKA">\n <RIst X="1" Y="2" Z="3" A="4" B="5" C="6"/>\n <AIPos {axes}/>\n'
    ' <EIPos E1="0.0"/>\n <IPOC>{ipoc}</IPOC>\n</Rob>\n'
)


def frames(count=4) -> str:
    out = []
    for t, q in zip(T[:count], np.degrees(Q), strict=False):
        axes = " ".join(f'A{k}="{v:.12f}"' for k, v in enumerate(q, 1))
        out.append(RSI.format(axes=axes, ipoc=4_208_163_634 + round(1e3 * t)))
    return "".join(out)


def test_frames_of_rsi(tmp_path, robot) -> None:
    path = tmp_path / "rsi.xml"
    path.write_text("received:\n" + frames() + '<Rob Type="KUKA"><AIPos A1', "utf-8")
    check(path, robot)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<IPOC>4208163644</IPOC>", "", r"rsi\.xml:7: a frame without <IPOC>"),
        ("A3=", "B3=", r"rsi\.xml:1: a frame without A3 in <AIPos>"),
        ('E1="0.0"', 'E1="x"', None),
        ('A1="', 'A1="x', r"rsi\.xml:1: A1 of <AIPos> is 'x"),
    ],
)
def test_broken_frames_name_their_line(tmp_path, robot, old, new, message) -> None:
    path = tmp_path / "rsi.xml"
    path.write_text(frames().replace(old, new), "utf-8")
    if message is None:
        check(path, robot)  # the robot has no external axis to ask for
        return
    with pytest.raises(InputError, match=message):
        read_samples(path, robot)


# Columns


def columns(tmp_path, text):
    path = tmp_path / "columns.toml"
    path.write_text(text, "utf-8")
    return load_columns(path)


def test_columns_by_name_with_units(tmp_path, robot) -> None:
    head = ["x", *(f"axis {k}" for k in range(6)), "stamp"]
    path = tmp_path / "log.csv"
    rows = [
        f"a|{'|'.join(map(repr, map(float, q)))}|{1e6 * t}"
        for t, q in zip(T, np.degrees(Q), strict=True)
    ]
    path.write_text("\n".join(["|".join(head), *rows]), "utf-8")
    names = ", ".join(f'"axis {k}"' for k in range(6))
    check(
        path,
        robot,
        columns(
            tmp_path,
            f'delimiter = "|"\ntime = {{ column = "stamp", unit = "us" }}\n'
            f'joints = {{ columns = [{names}], unit = "deg" }}\n',
        ),
    )


def test_columns_by_number_without_header_and_time(tmp_path, robot) -> None:
    path = tmp_path / "log.csv"
    np.savetxt(path, Q, delimiter=",", fmt="%.15g")
    text = 'time = { period = 10, unit = "ms" }\njoints = { columns = [1, 2, 3, 4, 5, 6] }\n'
    check(path, robot, columns(tmp_path, text))


def test_external_axes_come_last(tmp_path) -> None:
    text = (
        'time = { column = "t" }\njoints = { columns = ["a"], unit = "deg" }\n'
        'external = { columns = ["b"], unit = "mm" }\n'
    )
    found = columns(tmp_path, text)
    assert found.axes == ("a", "b")
    assert found.scales == pytest.approx((np.pi / 180, 1e-3))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time = 3", "time must be a table"),
        ("x = 3", "unknown key 'x'"),
        ('time = { column = "t" }', "joints is missing"),
        ('joints = { columns = ["a"] }', "time is missing"),
        ('time = { column = "t" }\njoints = { columns = [] }', "no column of joints"),
        ('time = { column = "t" }\njoints = { columns = [true] }', "a column is a name"),
        ('time = { column = "t" }\njoints = { columns = "q1" }', "must be a list"),
        ('time = { column = "t", unit = "min" }\njoints = { columns = ["a"] }', "time.unit"),
        ('time = { column = "t" }\njoints = { columns = ["a"], unit = "°" }', "joints.unit"),
        ('time = { }\njoints = { columns = ["a"] }', "either a column or a period"),
        ('time = { period = "x" }\njoints = { columns = ["a"] }', "must be a number"),
        ('time = { period = -1 }\njoints = { columns = ["a"] }', "above zero"),
        ('time = { period = nan }\njoints = { columns = ["a"] }', "above zero"),
        ('delimiter = ""\ntime = { column = "t" }\njoints = { columns = ["a"] }', "one character"),
        ("time = {", "is not TOML"),
    ],
)
def test_broken_columns_name_file_and_key(tmp_path, text, message) -> None:
    with pytest.raises(InputError, match=rf"columns\.toml: .*{re.escape(message)}"):
        columns(tmp_path, text)


def test_columns_that_are_not_there_are_named(tmp_path, robot) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text_of(HEADS["plain"], T, Q), "utf-8")
    for wanted, message in (
        ('"q9"', "'q9' is missing"),
        ("9", "no column 9"),
        ('"t", "t"', "twice"),
    ):
        text = f"time = {{ period = 0.01 }}\njoints = {{ columns = [{wanted}] }}\n"
        with pytest.raises(InputError, match=message):
            read_samples(path, robot, columns(tmp_path, text))


# What flyby's own recorders write


@pytest.mark.parametrize(
    ("name", "period", "speed"),
    [
        ("abb/irb6640-180-255", 0.012, Speed(tcp=0.5)),
        ("abb/irb6640-180-255", 0.2, Speed(tcp=0.5)),
        ("kuka/kr3-r540", 0.012, Speed()),
        ("ur/ur10e", 0.008, Speed(joint=1.0, joint_acceleration=1.0)),
    ],
)
def test_what_a_recorder_writes_is_read(tmp_path, name, period, speed) -> None:
    robot, vendor = find_robot(name), find_vendor(name.split("/")[0])
    move = MoveJ(JointTarget((0.0, -1.0, 1.0, 0.0, 0.5, 0.0)), speed, FINE)
    program = Program((move,), start=JointTarget((0.0,) * 6))
    source = "\n".join(vendor.record(program, robot, period).values())
    # The pieces of the head as the program writes them, put together as it does.
    pieces = re.findall(r'(?:Write fbFile,|HANDLE,|socket_send_line\()"(t?[,q\d]*q\d|t)"', source)
    head = "".join(pieces)
    assert head == "t,q1,q2,q3,q4,q5,q6"
    rows = [" " + ",".join(f"{v:.7f}" for v in (t, *q)) for t, q in zip(T, Q, strict=True)]
    path = tmp_path / "flyby_log.csv"
    path.write_text("\r\n".join([head, *rows, ""]), "ascii")
    samples = read_samples(path, robot)
    np.testing.assert_allclose(samples.t, T, atol=1e-7)
    np.testing.assert_allclose(samples.q, Q, atol=1e-7)


# Hostile text

PIECES = [
    *(cell for head in HEADS.values() for cell in head),
    *(
        "<Rob>",
        "</Rob>",
        "<AIPos A1='1'",
        "/>",
        "<IPOC>",
        "</IPOC>",
        "9" * 400,
        "1e999",
        "nan",
        "-inf",
    ),
    *(
        ",",
        ";",
        "\t",
        " ",
        "\n",
        "\r\n",
        '"',
        "#",
        "0",
        "1.5",
        "-3",
        "\0",
        "\ufeff",
        "٣",
        "1_0",
        "é",
    ),
]
quiet = settings(
    max_examples=150,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def survives(path: Path, robot, mapping=None) -> None:
    try:
        samples = read_samples(path, robot, mapping)
    except FlybyError as error:
        assert str(path) in str(error)
        return
    assert samples.q.shape == (len(samples.t), robot.size)
    assert (np.diff(samples.t) > 0).all()
    assert np.isfinite(samples.q).all()


@quiet
@given(data=st.binary(max_size=400))
def test_bytes_are_read_or_refused(tmp_path, robot, data) -> None:
    path = tmp_path / "log"
    path.write_bytes(data)
    survives(path, robot)


@quiet
@given(pieces=st.lists(st.sampled_from(PIECES), max_size=60))
def test_pieces_of_logs_are_read_or_refused(tmp_path, robot, pieces) -> None:
    path = tmp_path / "log"
    path.write_text("".join(pieces), "utf-8")
    survives(path, robot)


@quiet
@given(data=st.data())
def test_damaged_logs_are_read_or_refused(tmp_path, robot, data) -> None:
    form = data.draw(st.sampled_from([*HEADS, "frames"]))
    text = frames() if form == "frames" else text_of(HEADS[form], T, Q)
    begin = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(begin, min(begin + 40, len(text))))
    path = tmp_path / "log"
    path.write_text(text[:begin] + data.draw(st.sampled_from(PIECES)) + text[end:], "utf-8")
    survives(path, robot)


@quiet
@given(text=st.text(max_size=200))
def test_files_of_columns_are_read_or_refused(tmp_path, text) -> None:
    path = tmp_path / "columns.toml"
    path.write_text(text, "utf-8")
    try:
        load_columns(path)
    except InputError as error:
        assert str(path) in str(error)


def test_a_missing_file_a_folder_and_many_open_frames(tmp_path, robot) -> None:
    for path in (tmp_path / "absent", tmp_path):
        with pytest.raises(InputError, match="cannot be read"):
            read_samples(path, robot)
    path = tmp_path / "rsi.xml"
    path.write_text("<Rob" * 200_000 + "</Rob>" * 2, "utf-8")
    with pytest.raises(InputError, match="IPOC"):
        read_samples(path, robot)
