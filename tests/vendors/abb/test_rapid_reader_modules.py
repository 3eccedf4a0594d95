"""Programs of several modules: files beside each other, lists, LOCAL names, entries."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.core.errors import InputError, SourceError
from flyby.core.program.question import QuestionKind
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import Reading, ReadOptions
from flyby.core.source.text.files import SourceFile
from flyby.vendors.abb.run.reader import read, read_file, read_sources

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def point(x):
    return f"[[{x},0,600],[0,0,1,0],[0,0,0,0],{UNUSED}]"


def move(x, tool="tool0"):
    return f"MoveL {point(x)},v100,fine,{tool};"


def module(name, *items):
    return "\n".join([f"MODULE {name}", *items, "ENDMODULE"])


def proc(name, body):
    return f"PROC {name}()\n{body}\nENDPROC"


def folder(tmp_path, **files):
    for name, text in files.items():
        path = tmp_path / name.replace("__", "/").replace("_", ".")
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(text.encode("cp1252"))
    return tmp_path


def xs(program):
    return [round(m.target.pose.position[0] * 1000) for m in program.moves]


def test_an_old_copy_of_the_program_is_none_of_its_files(tmp_path):
    text = module("Main", proc("main", "rPick;"), proc("rPick", move(1)))
    old = module("MAIN(NOSTEPIN)", proc("main", "rPick;"), proc("rGone", move(2)))
    path = folder(tmp_path, Main_mod=text, Main2_mod=old, Pick_mod=module("Pick"))
    program = read_file(path / "Main.mod")
    assert {Path(name).name for name in program.reading.files} == {"Main.mod", "Pick.mod"}


def test_of_several_states_of_a_module_the_one_called_like_it_is_taken(tmp_path):
    def data(x):
        return module("Data", f"CONST robtarget p1:={point(x)};")

    path = folder(
        tmp_path,
        Main_mod=module("Main", proc("main", "MoveL p1,v100,fine,tool0;")),
        DATA_mod=data(1),
        Data2_mod=data(2),
    )
    assert xs(read_file(path / "Main.mod")) == [1]
    (path / "DATA.mod").rename(path / "Data1.mod")
    with pytest.raises(SourceError, match=r"declared in .*Data1.mod and in .*Data2.mod"):
        read_file(path / "Main.mod")


def test_a_module_beside_is_taken_in_when_it_alone_declares_a_name(tmp_path):
    path = folder(
        tmp_path,
        Main_mod=module("Main", proc("main", f"{move(1, 'tGrip')}\nrPick;\nIF fReady() {move(3)}")),
        Data_sys=module(
            "Data(SYSMODULE, NOSTEPIN)",
            "PERS tooldata tGrip:=[TRUE,[[0,0,nLength],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];",
            "LOCAL CONST num nLength:=120;",
        ),
        Pick_modx=module("Pick", proc("rPick", move(2)), "FUNC bool fReady() RETURN TRUE; ENDFUNC"),
        Broken_mod="MODULE Broken PROC rElse( ENDMODULE",
        Notes_txt="nothing",
    )
    program = read_file(path / "Main.mod")
    assert xs(program) == [1, 2, 3]
    assert program.moves[0].tool.tcp.position[2] == 0.12
    said = " ".join(note.message for note in program.notes)
    assert "module Data of " in said and "declares 'tgrip'" in said and "module Pick of " in said
    assert "Broken" not in said
    reading = program.reading
    assert isinstance(reading, Reading)
    assert reading.again({}).statements == program.statements
    name = str(path / "Pick.modx")
    changed = SourceFile(name, reading.files[name].text.replace("[[2,", "[[22,"), "utf-8")
    assert xs(reading.again({name: changed})) == [1, 22, 3]


def test_two_modules_that_declare_a_name_are_an_error_naming_both(tmp_path):
    path = folder(
        tmp_path,
        a_mod=module("A", proc("main", "rPick;")),
        b_mod=module("B", proc("rPick", move(2))),
        c_mod=module("C", proc("rPick", move(3))),
    )
    with pytest.raises(SourceError, match=r"'rpick' is declared in .*b\.mod and in .*c\.mod"):
        read_file(path / "a.mod")
    program = read_file(path / "a.mod", ReadOptions(others=(path / "c.mod",)))
    assert xs(program) == [3]


def test_other_programs_and_copies_beside_are_not_taken_in(tmp_path):
    path = folder(
        tmp_path,
        a_mod=module("A", proc("main", "rPick;")),
        copy_mod=module("A", proc("main", move(9)), proc("rPick", move(9))),
        other_mod=module("B", proc("main", move(8)), proc("rPick", move(8))),
    )
    (note,) = read_file(path / "a.mod").notes
    assert "rPick" in note.message and "also declares main anew" in note.message


def test_a_module_that_is_needed_and_broken_fails_with_its_own_place(tmp_path):
    path = folder(
        tmp_path,
        a_mod=module("A", proc("main", "rPick;")),
        b_mod="MODULE B\nPROC rPick()\nMoveL ;\nENDPROC\nPROC\nENDMODULE",
    )
    with pytest.raises(SourceError, match=r"b\.mod:6:1: the keyword ENDMODULE"):
        read_file(path / "a.mod")


def test_system_modules_of_a_backup(tmp_path):
    folder(
        tmp_path,
        PROGMOD__main_mod=module("M", proc("main", move(1, "tUser"))),
        SYSMOD__user_sys=module(
            "USER(SYSMODULE)",
            "PERS tooldata tUser:=[TRUE,[[0,0,5],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];",
        ),
    )
    program = read_file(tmp_path / "PROGMOD" / "main.mod")
    assert program.moves[0].tool.name == "tUser"


LIST = '<?xml version="1.0" encoding="ISO-8859-1" ?>\r\n<Program>\r\n{}</Program>\r\n'


def listing(*names):
    return LIST.format("".join(f"\t<Module>{name}</Module>\r\n" for name in names))


def test_a_list_of_modules_as_the_program(tmp_path):
    path = folder(
        tmp_path,
        cell_pgf=listing("Work.mod", "start.MOD"),
        work_mod=module("Work", proc("rPick", move(2))),
        start_mod=module("Start", proc("main", f"{move(1)}\nrPick;")),
        stray_mod=module("Stray", proc("rPick", move(7))),
    )
    program = read_file(path / "cell.pgf")
    assert xs(program) == [1, 2] and program.name == "Start"
    assert xs(read_file(path / "start.mod")) == [1, 2]  # the list rules the stray one out
    (path / "work.mod").unlink()
    with pytest.raises(InputError, match=r"cell\.pgf lists Work\.mod"):
        read_file(path / "cell.pgf")
    (path / "cell.pgf").write_text(listing())
    with pytest.raises(InputError, match="lists no module"):
        read_file(path / "cell.pgf")


def test_local_names_belong_to_their_module():
    first = module(
        "A",
        "LOCAL CONST num nX:=1;",
        "LOCAL VAR num nCount:=10;",
        "LOCAL RECORD pair num a; num b; ENDRECORD",
        "LOCAL CONST pair both:=[4,5];",
        proc("main", f"{move('nX')}\nrSub;\nrOther;\n{move('nCount')}\n{move('both.b')}"),
        "LOCAL " + proc("rSub", move(2)),
    )
    second = module(
        "B",
        "LOCAL CONST num nX:=31;",
        "LOCAL RECORD pair string a; ENDRECORD",
        'LOCAL CONST pair both:=["x"];',
        proc("rOther", f"{move('nX')}\nrSub;"),
        "LOCAL " + proc("rSub", move(32)),
    )
    assert xs(read(f"{first}\n{second}", "a.mod")) == [1, 2, 31, 32, 10, 5]
    third = module("C", proc("rPub", "rSub;"))
    files = {n: SourceFile(n, t) for n, t in (("a.mod", first), ("c.mod", third))}
    (note,) = read_sources(files, "a.mod", ReadOptions("rPub", others=(Path("c.mod"),))).notes
    assert str(note).startswith("c.mod:3:1: unknown instruction or routine 'rSub'")


def test_a_global_name_declared_twice_is_an_error_with_both_places():
    files = {
        "a.mod": SourceFile("a.mod", module("A", proc("main", ""), proc("same", ""))),
        "b.mod": SourceFile("b.mod", module("B", proc("same", ""))),
    }
    with pytest.raises(SourceError, match=r"b\.mod:2:1: same is declared twice: first in a\.mod"):
        read_sources(files, "a.mod", ReadOptions(others=(Path("b.mod"),)))


@pytest.mark.parametrize(
    ("file", "name", "procs", "expected"),
    [
        ("a.mod", "M", {"rOne": move(1), "Main": move(2)}, [2]),
        ("a.mod", "M", {"rOne": move(1)}, [1]),
        ("C:\\x\\rTwo.mod", "M", {"rOne": move(1), "rTwo": move(2)}, [2]),
        ("a.mod", "rTwo", {"rOne": move(1), "rTwo": move(2)}, [2]),
        ("a.mod", "M", {"rAll": "rOne;\nrTwo;", "rOne": move(1), "rTwo": move(2)}, [1, 2]),
        ("a.mod", "M", {"rInit": "SetDO d,1;", "rTwo": move(2)}, [2]),
        ("a.mod", "M", {"rOne": move(1), "Main_Cell": move(2)}, [2]),
    ],
)
def test_the_entry_of_a_module_without_main(file, name, procs, expected):
    text = module(name, *(proc(n, body) for n, body in procs.items()))
    program = read(text, file)
    assert xs(program) == expected
    assert ("main" in [n.lower() for n in procs]) or "there is no PROC main" in str(program.notes)


def test_entries_that_are_refused():
    text = module("M", proc("a", move(1)), proc("b", move(2)))
    with pytest.raises(SourceError, match=r"one of a \(1 move\), b"):
        read(text, "x.mod")
    with pytest.raises(SourceError, match="unknown procedure 'c'"):
        read(text, "x.mod", ReadOptions("c"))
    with pytest.raises(SourceError, match="no routine in it can be run"):
        read(module("D", "VAR num k;"), "x.sys")


def test_an_entry_in_a_module_beside(tmp_path):
    path = folder(
        tmp_path,
        a_mod=module("A", proc("main", move(1))),
        b_mod=module("B", proc("rPick", move(2))),
    )
    assert xs(read_file(path / "a.mod", ReadOptions("rPick"))) == [2]


def test_variables_of_the_system_module_user():
    assert xs(
        read(module("M", proc("main", f"reg1:=5;\nClkReset clock1;\n{move('reg1+reg2')}")), "a")
    ) == [5]


@pytest.mark.parametrize(
    ("called", "routines", "wanted"),
    [
        ("Paint:Main", "", []),  # its module is not at hand, and main is not meant
        ("Paint:Main", "paint", [7]),
        ("M:pick", "", [3]),
        ("paint:inner", "paint", [8]),  # one that only its own module sees
    ],
)
def test_a_routine_that_is_called_with_its_module_is_of_that_module(
    tmp_path, called, routines, wanted
):
    main = module("M", proc("main", move(1) + f'\n%"{called}"%;'), proc("pick", move(3)))
    paint = module("Paint", "LOCAL " + proc("Main", move(7)), "LOCAL " + proc("inner", move(8)))
    folder(tmp_path, m_mod=main, **({"paint_mod": paint} if routines else {}))
    others = (tmp_path / "paint.mod",) if routines else ()
    answers = Answers(skipped=frozenset({"paint:main"}))
    program = read_file(tmp_path / "m.mod", ReadOptions(answers=answers, others=others))
    assert [round(1000 * m.target.pose.position[0]) for m in program.moves] == [1, *wanted]
    missing = [q.key for q in program.questions if q.kind is QuestionKind.ROUTINE]
    assert missing == ([] if wanted else ["Paint:Main"])
