"""RAPID text → tokens and tree: forms, positions, refusals."""

from __future__ import annotations

import codecs

import pytest

from flyby.core.errors import SourceError
from flyby.core.source.text.files import SourceText, decode
from flyby.vendors.abb.run.reader import read
from flyby.vendors.abb.syntax.lexer import END, number_value, string_value, tokenize
from flyby.vendors.abb.syntax.parser import parse
from flyby.vendors.abb.syntax.tree import Assign, If, Number, Operation, Unary

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
P = f"[[500,0,600],[0,0,1,0],[0,0,0,0],{UNUSED}]"


def tree(text):
    return parse(SourceText(text, "a.mod"))


def statements(body):
    return tree(f"MODULE M\nPROC main()\n{body}\nENDPROC\nENDMODULE")[0].routines[0].body.statements


def expression(text):
    (statement,) = statements(f"x := {text};")
    assert isinstance(statement, Assign)
    return statement.value


def error_at(text):
    with pytest.raises(SourceError) as caught:
        read(text, "a.mod")
    span = caught.value.span
    assert span is not None
    assert str(caught.value).startswith(f"a.mod:{span.line}:{span.column}: ")
    return span.line, span.column, str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *[("12", 12), ("1.", 1), (".5", 0.5), ("1.5E-3", 0.0015), ("9E9", 9e9)],
        *[("9E+09", 9e9), ("0xff", 255), ("0o17", 15), ("0b101", 5)],
    ],
)
def test_numbers(text, value):
    assert number_value(text) == value
    node = expression(text)
    assert isinstance(node, Number) and node.value == value


def test_strings_escape_quotes_and_codes():
    assert string_value('"a""b"') == 'a"b'
    assert string_value(r'"\41\\"') == "A\\"


def test_names_have_letters_of_any_language_and_no_case():
    (module,) = tree("module Größe\nvar NUM Höhe := 1;\nendMODULE")
    assert (module.name, module.text) == ("größe", "Größe")
    assert (module.declarations[0].name, module.declarations[0].type) == ("höhe", "num")


def test_header_attributes_and_comments():
    header = "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n! hi\n"
    text = header + "MODULE M(SYSMODULE, NOSTEPIN) ! x\nENDMODULE"
    (module,) = tree(text)
    assert module.attributes == ("sysmodule", "nostepin")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_and_columns_with_any_line_end(end):
    text = end.join(["MODULE M", "PROC main()", "  x := $;", "ENDPROC", "ENDMODULE"])
    assert error_at(text)[:2] == (3, 8)


def test_a_sign_belongs_to_the_number():
    node = expression("[-1.5, - 2, 3]")
    spans = [(item.span.column, item.span.end - item.span.start) for item in node.items]
    assert [item.value for item in node.items] == [-1.5, -2, 3]
    assert spans == [(7, 4), (13, 3), (18, 1)]


def test_priorities():
    total = expression("1 + 2 * 3 - 4")
    assert isinstance(total, Operation) and [s for s, _ in total.rest] == ["+", "-"]
    negated = expression("NOT a AND b")
    assert isinstance(negated, Unary) and isinstance(negated.operand, Operation)
    mixed = expression("a AND NOT b OR c")
    assert [s for s, _ in mixed.rest] == ["or"]


def test_compact_if_holds_one_statement():
    (statement,) = statements("IF a > 1 b := 2;")
    assert isinstance(statement, If) and len(statement.branches[0].body.statements) == 1


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("", (1, 1), "no module"),
        ("hello", (1, 1), "MODULE"),
        ("MODULE M\nPROC main()\nMoveJ p,v,", (3, 11), "cut off"),
        ("MODULE M\nCONST num a:=1\nCONST num b:=2;\nENDMODULE", (3, 1), "';'"),
        ('MODULE M\nCONST string s:="abc;\nENDMODULE', (2, 17), "closing quote"),
        ("MODULE M\nPROC main()\nIF a THEN\nENDPROC\nENDMODULE", (4, 1), "ENDPROC"),
        ("MODULE M\nCONST pos p:=[1,2;\nENDMODULE", (2, 18), "']'"),
        ("MODULE M\nCONST num a:=1E999;\nENDMODULE", (2, 14), "too large"),
        ("MODULE M\n\x00\x01\nENDMODULE", (2, 1), "binary"),
        ("PROC Path_10()\nENDPROC\n", (1, 1), "this is a part of a module"),
        ("MODULE 2weld\nENDMODULE", (1, 8), "the number 2 stands where the module's name"),
        ("MODULE M\nCONST string s:='a';\nENDMODULE", (2, 17), 'strings stand in "'),
    ],
)
def test_errors_say_where_and_what(text, place, words):
    line, column, message = error_at(text)
    assert (line, column) == place
    assert words in message


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            "IF a THEN\nb;\nENDPROC",
            "the keyword ENDPROC stands where ENDIF, to close the IF of line 3",
        ),
        (
            "FOR i FROM 1 TO 2 DO\nENDWHILE",
            "ENDWHILE stands where ENDFOR, to close the FOR of line 3",
        ),
        ("WHILE a DO\nERROR\n", "ERROR stands where ENDWHILE, to close the WHILE of line 3"),
        ("TEST a\nCASE 1:\nb;\nENDIF", "ENDIF stands where ENDTEST, to close the TEST of line 3"),
        ("b;\nPROC c()\n", "PROC stands where ENDPROC, to close PROC main of line 2"),
        ("IF a THEN\nb;\n", "file ends where ENDIF, to close the IF of line 3, should follow"),
    ],
)
def test_an_open_block_is_named_with_its_line(body, words):
    with pytest.raises(SourceError, match=words):
        parse(SourceText(f"MODULE m\nPROC main()\n{body}", "m.mod"))


def test_deep_nesting_is_refused_and_not_a_crash():
    for text in ("(" * 5000, "[" * 5000, "- " * 5000, "NOT " * 5000, "a{" * 5000, "f(" * 5000):
        message = error_at(f"MODULE M\nPROC main()\nx := {text}")[2]
        assert "inside each other" in message
    assert "inside" in error_at("MODULE M\nPROC main()\n" + "IF a THEN\n" * 5000)[2]
    assert "inside" in error_at("MODULE M\nPROC main()\n" + "IF a " * 5000)[2]


def test_a_long_sum_is_not_deep():
    body = "x := " + "+".join(["1"] * 20_000) + ";"
    text = (
        f"MODULE M\nPROC main()\nVAR num x;\n{body}\nMoveJ {P},v100,fine,tool0;\nENDPROC\nENDMODULE"
    )
    assert len(read(text, "a.mod").moves) == 1


def test_decoding_keeps_every_byte():
    for data in (b"abc", "é".encode(), b"\xef\xbb\xbfabc", b"\xe9\x80", bytes(range(256))):
        text, codec = decode(data, "a.mod")
        assert text.encode(codec) == data


@pytest.mark.parametrize("codec", ["utf-16", "utf-16-be"])
def test_wide_modules_are_read(codec):
    text = f"MODULE M ! größer\nPROC main() MoveJ {P},v100,fine,tool0; ENDPROC ENDMODULE"
    mark = codecs.BOM_UTF16_BE if codec == "utf-16-be" else b""
    made = read(mark + text.encode(codec), "a.mod")
    assert len(made.moves) == 1
    assert any("the file is UTF-16, which controllers do not read" in n.message for n in made.notes)


@pytest.mark.parametrize("prefix", [b"\xef\xbb\xbf", b"! Gr\xf6\xdfe\r\n", b"! \xc3\xb6\n", b""])
def test_byte_order_marks_and_code_page_1252(prefix):
    text = f"MODULE M PROC main() MoveJ {P},v100,fine,tool0; ENDPROC ENDMODULE"
    assert len(read(prefix + text.encode(), "a.mod").moves) == 1


def test_tokens_end_with_the_end():
    tokens = tokenize(SourceText("  ! nothing\n", "a"))
    assert tokens.kinds == [END]


def test_handlers_traps_records_and_labels_parse():
    text = f"""
    MODULE M
      RECORD part
        num width;
        robtarget place;
      ENDRECORD
      ALIAS num level;
      TRAP onStop
        StopMove;
      ENDTRAP
      PROC main()
        VAR part a;
        CONNECT i1 WITH onStop;
        a.place := {P};
        MoveJ a.place,v100,fine,tool0;
      ERROR (ERR_PATH, 12)
        RETRY;
      UNDO
        Reset do1;
      BACKWARD
        MoveJ a.place,v100,fine,tool0;
      ENDPROC
    ENDMODULE"""
    program = read(text, "a.mod")
    assert len(program.moves) == 1


def test_a_placeholder_is_stepped_over_where_it_runs():
    text = "MODULE M\nPROC main()\nIF FALSE THEN\n<SMT>\nENDIF\n{}\nENDPROC\nENDMODULE"
    assert read(text.format(""), "a").notes == ()
    assert "<SMT>" in read(text.format("<SMT>"), "a").notes[0].message
