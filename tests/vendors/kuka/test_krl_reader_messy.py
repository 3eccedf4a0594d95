"""Programs as cells have them, errors with their place, and properties that hold for any text."""

# ruff: noqa: E501 - lines of programs are as long as programs have them

from __future__ import annotations

import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import FlybyError, SourceError
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.source.reading import ReadOptions
from flyby.core.source.text.files import SourceText
from flyby.vendors.kuka.language import Krl
from flyby.vendors.kuka.syntax.lexer import END, tokenize

MESSY = """\ufeff&ACCESS RVP1
&REL 73
&PARAM EDITMASK = *
&PARAM TEMPLATE = C:\\KRC\\Roboter\\Template\\vorgabe
&COMMENT Türen schweißen, Zelle 3
def  Tueren ( )
;fold Deklarationen ;%{E}
  int i,zaehler
  Decl Bool fertig
  frame Versatz
;endfold (Deklarationen)
;FOLD INI;%{PE}
\t;FOLD BASISTECH INI
\t\tGLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )
\t\tINTERRUPT ON 3\x20
\t\tbas (#initmov,0 )
\t;ENDFOLD (BASISTECH INI)
\t;FOLD SPOTTECH INI
\t\tUSERSPOT(#INIT)
\t;ENDFOLD (SPOTTECH INI)
;ENDFOLD (INI)


;FOLD PTP HOME  Vel= 100 % DEFAULT;%{PE}%R 5.2.20,%MKUKATPBASIS,%CMOVE,%VPTP,%P 1:PTP, 2:HOME, 3:, 5:100, 7:DEFAULT
$BWDSTART = FALSE
PDAT_ACT=PDEFAULT
FDAT_ACT=FHOME
BAS (#PTP_PARAMS,100 )
$H_POS=XHOME
PTP  XHOME
;ENDFOLD
zaehler = 0
fertig=false
versatz = {x 0,y 0,z 120,a 0,b 0,c 0}
while not fertig   ; bis zum Schluß
\tfor i = 1 to 2
      $VEL . CP = 0.2 * i
      lin XP[i] : versatz C_DIS
\t\tlin xp[ i ]   c_dis
      if (i == 2) and (zaehler >= 0) then ; "nur" beim zweiten
         circ {x 510,y 40,z 300},{X 520.0 , Y 80 , Z 300 , A 0,B 90 , C 0} C_ORI
      endif
   endfor
   zaehler = zaehler+1
   fertig = (zaehler > 1)
endwhile
;FOLD OUT 5 '' State= TRUE ;%{PE}
$OUT[5]=TRUE
;ENDFOLD
;FOLD nie geschlossen
PTP XHOME
END ; ( Tueren )


"""
MESSY_DATA = """&ACCESS RVP1
DEFDAT  TUEREN PUBLIC
;FOLD EXTERNAL DECLARATIONS;%{PE}%MKUKATPBASIS,%CEXT,%VCOMMON,%P
EXT  BAS (BAS_COMMAND  :IN,REAL  :IN )
DECL INT SUCCESS
;ENDFOLD
DECL BASIS_SUGG_T LAST_BASIS={POINT1[] "P2                      ",POINT2[] "P2  ",CP_PARAMS[] "CPDAT0  "}
DECL E6POS XP[2]
XP[1]={X 500.0,Y 0.0,Z 300.0,A 0.0,B 90.0,C 0.0,S 'B010',T'B100011',E1 0.0}
XP[2]={E6POS: X 505.0,Y 20.0,Z 300.0,A 0.0,B 90.0,C 0.0,S 2,T 35,E1 0.0}
ENDDAT
"""


def folder_with(path, ends="\r\n", codec="cp1252", suffix=".DAT"):
    source = path / "Tueren.src"
    text = MESSY if codec.startswith("utf") else MESSY.removeprefix("\ufeff")
    source.write_bytes(text.removeprefix("\ufeff").replace("\n", ends).encode(codec))
    (path / f"tueren{suffix}").write_bytes(MESSY_DATA.replace("\n", ends).encode(codec))
    return source


@pytest.mark.parametrize("codec", ["cp1252", "utf-8", "utf-8-sig"])
@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_messy(tmp_path, ends, codec):
    program = Krl().read_file(folder_with(tmp_path, ends, codec), ReadOptions())
    kinds = [type(m) for m in program.moves]
    assert kinds == [MoveJ, *[MoveL, MoveL, MoveL, MoveL, MoveC] * 2, MoveJ]
    assert program.name == "Tueren"
    speeds = [m.speed.tcp for m in program.moves[1:6]]
    assert speeds == [0.2, 0.2, 0.4, 0.4, 0.4]
    above, at = program.moves[1].target.pose, program.moves[2].target.pose
    assert above.position == pytest.approx((0.62, 0, 0.3))  # z of the tool is x of the base
    assert at.position == (0.5, 0, 0.3)
    assert program.moves[2].target.name == "XP[1]"


def test_a_damaged_file_says_where(tmp_path, krl):
    for text, line, message in (
        ("DEF a( )\nLIN {X 1,Y}\nEND", 2, "'}' stands where a value should"),
        (
            "DEF a( )\nIF TRUE THEN\nHALT\nEND",
            4,
            "END stands where .*ENDIF, to close the IF of line 2",
        ),
        ("DEF a( )\nLOOP\n", 3, "the file ends where ENDLOOP, to close the LOOP of line 2"),
        ("DEF a( )\nHALT\nENDIF\nEND", 3, "ENDIF stands where .*END, to close DEF a"),
        ("DEF a( )\nx=1 2\nEND", 2, "2 stands where the end of the line"),
        ("DEF a( )\nx=\nEND", 2, "the line ends where a value should"),
        ("DEF a( )\nx=(1+2\nEND", 2, r"the line ends where '\)'"),
        ('DEF a( )\nx="abc\nEND', 2, "no closing quote"),
        ("DEF a( )\nx='Q12'\nEND", 2, "no number in quotes"),
        ("DEF a( )\nx=1\0\nEND", 2, "0x00 does not belong"),
        ("DEF a( )\nx=1E999\nEND", 2, "too large"),
        ("DEF a( )\nx=1/0\nEND", 2, "division by zero"),
        ("DEF a( )\nx={X 1E999}\nEND", 2, "too large"),
        ("LIN XP1", 1, "DEF, DEFFCT or DEFDAT"),
        ("", 1, "the file holds no DEF"),
        ("&ACCESS RVP\n; nothing", 1, "the file holds no DEF"),
        ("DEF a( )\nINT i\ni=TRUE\nEND", 3, "i: a whole number is wanted, not TRUE"),
        ("DEF a( )\nINT i\ni={X 1}\nEND", 3, "i: a whole number is wanted, not a structure"),
        ("DEF a( )\nBOOL b\nb=1+TRUE\nEND", 3, r"'\+' wants numbers"),
        ("DEF a( )\nINT n[3]\nn[4]=1\nEND", 3, "there is no n\\[4\\]: index 4 is outside 1 to 3"),
        ("DEF a( )\nFRAME f\nf.Q=1\nEND", 3, ": FRAME has no component Q"),
        ("DEF a( )\nGOTO nowhere\nEND", 2, "no label nowhere"),
        ("DEF a( )\nEXIT\nEND", 1, "EXIT stands outside a loop"),
        ("DEF a( )\nx=ABS(1,2)\nEND", 2, "ABS: it takes 1 argument, not 2"),
        ("DEF a( )\nx=SQRT(-1)\nEND", 2, "SQRT: there is no finite value"),
        ("DEF a( )\nBAS(#TOOL)\nEND", 2, "the number of a tool"),
    ):
        with pytest.raises(SourceError, match=message) as caught:
            krl(src=text)
        assert caught.value.span.line == line, text


def test_utf16_is_read(tmp_path):
    path = tmp_path / "a.src"
    path.write_bytes("DEF a( )\nHALT\nEND".encode("utf-16"))
    notes = Krl().read_file(path, ReadOptions()).notes
    assert any("UTF-16, which controllers do not read" in note.message for note in notes)


@pytest.mark.parametrize(
    "text",
    [
        "DEF a( )\nx=" + "(" * 5000 + "1" + ")" * 5000 + "\nEND",
        "DEF a( )\n" + "IF TRUE THEN\n" * 5000 + "END",
        "DEF a( )\nx=" + "-" * 5000 + "1\nEND",
        "DEF a( )\nx=" + "{A " * 5000 + "\nEND",
        "DEF a( )\nx=" + "1+" * 20000 + "1\nEND",
        "DEF a( )\nx=" + "9" * 20000 + "\nEND",
        "DEF a( )\nx={" + "X 1," * 20000 + "\nEND",
        "DEF a( )\n" + "x" * 100000 + "\nEND",
        "DEF a( )\nINT n[999999999]\nEND",
        "DEF a( )\nPTP x" + ".x" * 10000 + "\nEND",
        "DEF a( )\nx=1\nLOOP\nx=x*2\nIF x<0 THEN\nEXIT\nENDIF\nENDLOOP\nEND",
    ],
)
def test_deep_and_huge_texts_end_soon(krl, text):
    started = time.process_time()
    try:
        krl(src=text)
    except FlybyError as error:
        assert str(error).startswith("demo.src:")
    assert time.process_time() - started < 3.0  # a second where nobody else computes


PIECES = [
    "LIN ",
    "PTP XP1",
    "{X 1,Y 2,Z 3,A 0,B 0,C 0}",
    "{",
    "}",
    "(",
    ")",
    "=",
    ":",
    ",",
    "\n",
    ";FOLD\n",
    "IF ",
    "THEN\n",
    "ENDIF\n",
    "LOOP\n",
    "ENDLOOP\n",
    "1.5",
    "'B01'",
    "#BASE",
    '"a"',
    "$IN[1]",
    "$VEL.CP=0.5\n",
    "C_DIS\n",
    "DECL INT i\n",
    "i",
    "FOR i=1 TO 2\n",
    "ENDFOR\n",
    "END\n",
    "DEF b( )\n",
    "b()\n",
    "BAS(#INITMOV,0)\n",
    "&REL 1\n",
    "\0",
    "ü",
    "$POS_ACT",
    "WITH ",
    "\t",
]


@given(st.lists(st.sampled_from(PIECES), max_size=25))
@settings(max_examples=300, deadline=None)
def test_any_text_is_read_or_refused(krl, pieces):
    try:
        krl(src="DEF demo( )\n" + "".join(pieces) + "\nEND\n")
    except FlybyError as error:
        assert str(error)


@given(st.text(max_size=80))
def test_tokens_cover_the_text(text):
    source = SourceText(text, "a.src")
    try:
        tokens = tokenize(source)
    except SourceError:
        return
    assert tokens.kinds[-1] == END
    assert all(s <= e for s, e in zip(tokens.starts, tokens.ends, strict=True))
    assert all(e <= s for e, s in zip(tokens.ends, tokens.starts[1:], strict=False))


@given(st.data())
@settings(max_examples=100, deadline=None)
def test_damage_anywhere_is_met(tmp_path_factory, krl, data):
    text = MESSY.removeprefix("\ufeff")
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 30)))
    damaged = text[:start] + data.draw(st.sampled_from(PIECES)) + text[end:]
    try:
        krl(src=damaged, files={"tueren.dat": MESSY_DATA})
    except FlybyError as error:
        assert ".src:" in str(error)


@pytest.mark.parametrize(
    "text",
    [
        "&PARAM TPVW_VERSION = 8.1.8\nDEF folge1( )\n{}END\n",
        "DEF folge1( )\n;FOLD PTP VB=100% VE=0% ACC=100% RobWzg=1 Base=0 P;%{{P}}%MKUKATPVW\n{}END\n",
    ],
)
def test_programs_of_a_vkrc_are_read_with_a_warning(krl, text) -> None:
    program = krl(src=text.format("PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\n"))
    assert len(program.moves) == 1
    assert any("a VKRC (VW System Software)" in note.message for note in program.notes)
