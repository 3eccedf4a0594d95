"""Vendors come in through entry points, and one broken plugin hides no other."""

from __future__ import annotations

import sys
from importlib import metadata
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from flyby.core import registry as registry_module
from flyby.core.errors import InputError, OptionError, UnknownNameError
from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.plugins.loading import BrokenPlugin
from flyby.core.program.program import Program
from flyby.core.registry import Registry, vendors
from flyby.core.vendor import Vendor


class Language:
    """A reader and writer that say what they were given."""

    def read(self, text: str, file: str, options: Any) -> Any:
        return text, file, options.entry, options.robot

    def read_file(self, path: Any, options: Any) -> Any:
        return str(path), options.entry, options.robot

    def write(self, program: Any, robot: Any, options: Any) -> Any:
        return {"main.txt": f"{program.name} {robot.name} {options}"}


def vendor(name: str = "acme", **parts: Any) -> Vendor:
    given: dict[str, Any] = {
        "robots": {"arm-1": lambda: SimpleNamespace(name="arm-1")},
        "motion": lambda: object(),
        "label": lambda robot, q: None,
    }
    return Vendor(name, **(given | parts))


def plugin(*names: str, **parts: Any) -> ModuleType:
    module = ModuleType("_".join(("plugin", *names)))

    @hookimpl
    def flyby_register_vendors(register: VendorRegister) -> None:
        for name in names:
            register.add(vendor(name, **parts))

    module.flyby_register_vendors = flyby_register_vendors  # type: ignore[attr-defined]
    return module


@pytest.fixture
def entry_point(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Makes an entry point of a named distribution that loads the given object."""

    def make(name: str, target: Any, distribution: str = "flyby-test") -> metadata.EntryPoint:
        module = f"flyby_test_{name}_{distribution.replace('-', '_')}"
        if target is not None:
            holder = ModuleType(module)
            holder.plugin = target  # type: ignore[attr-defined]
            monkeypatch.setitem(sys.modules, module, holder)
        point = metadata.EntryPoint(name, f"{module}:plugin", "flyby")
        vars(point).update(dist=SimpleNamespace(name=distribution))
        return point

    return make


def broken(registry: Registry) -> BrokenPlugin:
    (one,) = registry.broken
    return one


def test_a_sound_plugin_registers_its_vendors(entry_point: Any) -> None:
    registry = Registry.discover([entry_point("acme", plugin("acme", "apex"))])
    assert sorted(registry.vendors) == ["acme", "apex"]
    assert registry.broken == ()
    assert registry.find_robot("acme/arm-1").name == "arm-1"
    assert registry.robot_names == ("acme/arm-1", "apex/arm-1")


def test_an_object_can_be_a_plugin(entry_point: Any) -> None:
    class Plugin:
        @hookimpl
        def flyby_register_vendors(self, register: VendorRegister) -> None:
            register.add(vendor("acme"))

    assert "acme" in Registry.discover([entry_point("acme", Plugin())]).vendors


def wrong_signature() -> ModuleType:
    module = ModuleType("wrong")

    @hookimpl
    def flyby_register_vendors(register: VendorRegister, robots: object) -> None:
        register.add(vendor("wrong"))

    module.flyby_register_vendors = flyby_register_vendors  # type: ignore[attr-defined]
    return module


def unknown_hook() -> ModuleType:
    module = plugin("wrong")

    @hookimpl
    def flyby_register_robots(register: VendorRegister) -> None: ...

    module.flyby_register_robots = flyby_register_robots  # type: ignore[attr-defined]
    return module


def raising_hook(error: BaseException) -> ModuleType:
    module = ModuleType("raising")

    @hookimpl
    def flyby_register_vendors(register: VendorRegister) -> None:
        register.add(vendor("half"))
        raise error

    module.flyby_register_vendors = flyby_register_vendors  # type: ignore[attr-defined]
    return module


def without_marker() -> ModuleType:
    module = ModuleType("unmarked")
    module.flyby_register_vendors = lambda register: None  # type: ignore[attr-defined]
    return module


def adding(what: Any) -> ModuleType:
    module = ModuleType("adding")

    @hookimpl
    def flyby_register_vendors(register: VendorRegister) -> None:
        register.add(what)

    module.flyby_register_vendors = flyby_register_vendors  # type: ignore[attr-defined]
    return module


@pytest.mark.parametrize(
    ("target", "error", "message"),
    [
        (None, ModuleNotFoundError, "No module named"),
        (wrong_signature(), Exception, "robots"),
        (unknown_hook(), Exception, "flyby_register_robots"),
        (raising_hook(ZeroDivisionError("by design")), ZeroDivisionError, "by design"),
        (raising_hook(SystemExit("leaves")), SystemExit, "leaves"),
        (without_marker(), InputError, "@hookimpl"),
        (plugin(), InputError, "adds nothing"),
        (plugin("twin", "twin"), InputError, "'twin' is registered already"),
        (plugin("acme"), InputError, "'acme' is registered already"),
        (plugin("empty", robots={}), InputError, "robots"),
        (adding({"name": "dict"}), InputError, "takes a Vendor"),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_a_broken_plugin_is_reported_and_hides_no_other(
    entry_point: Any, target: Any, error: type[BaseException], message: str
) -> None:
    points = [
        entry_point("acme", plugin("acme"), "flyby"),
        entry_point("bad", target, "flyby-bad"),
        entry_point("zeta", plugin("zeta"), "flyby-zeta"),
    ]
    registry = Registry.discover(reversed(points))
    assert sorted(registry.vendors) == ["acme", "zeta"]
    assert isinstance(broken(registry).error, error)
    assert message in str(broken(registry))
    assert "'bad' of flyby-bad" in str(broken(registry))


def test_a_stranger_takes_no_shipped_name(entry_point: Any) -> None:
    ours, theirs = plugin("abb"), plugin("abb")
    points = [entry_point("abb", theirs, "aaa"), entry_point("abb", ours, "flyby")]
    assert broken(Registry.discover(points)).distribution == "aaa"


def test_an_interrupt_is_not_swallowed(entry_point: Any) -> None:
    with pytest.raises(KeyboardInterrupt):
        Registry.discover([entry_point("bad", raising_hook(KeyboardInterrupt()))])


def test_unknown_names_get_suggestions(entry_point: Any) -> None:
    registry = Registry.discover([entry_point("acme", plugin("acme", "apex"))])
    with pytest.raises(UnknownNameError, match=r"unknown vendor 'acmee': did you mean 'acme'"):
        registry.find_vendor("acmee")
    with pytest.raises(UnknownNameError, match=r"unknown robot 'acme/arm-2'.*acme/arm-1"):
        registry.find_robot("acme/arm-2")
    with pytest.raises(InputError, match=r"robot 'arm-1': which\? acme/arm-1, apex/arm-1"):
        registry.find_robot("arm-1")
    with pytest.raises(UnknownNameError, match=r"robot of acme 'arm'"):
        registry.find_vendor("acme").robot("arm")


def test_an_unknown_vendor_names_its_broken_plugin(entry_point: Any) -> None:
    registry = Registry.discover([entry_point("bad", raising_hook(OSError("no disk")), "acme-bad")])
    with pytest.raises(UnknownNameError, match=r"bad.*acme-bad is broken: OSError: no disk"):
        registry.find_robot("bad/arm")


def test_the_installed_registry_is_built_once(monkeypatch: pytest.MonkeyPatch) -> None:
    registry_module.installed.cache_clear()
    calls: list[str] = []
    found = metadata.entry_points(group="flyby")
    monkeypatch.setattr(
        registry_module.metadata, "entry_points", lambda group: calls.append(group) or found
    )
    first = registry_module.installed()
    assert registry_module.installed() is first
    assert calls == ["flyby"]
    assert first.broken == ()
    assert {"abb", "kuka", "ur"} <= {v.name for v in registry_module.vendors()}
    registry_module.installed.cache_clear()


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"name": "ACME"}, "lower-case"),
        ({"name": ""}, "lower-case"),
        ({"robots": None}, "robots"),
        ({"robots": {"Arm 1": lambda: None}}, "lower-case"),
        ({"robots": {"arm-1": "arm-1.toml"}}, "loader"),
        ({"motion": None}, "'motion' is missing"),
        ({"label": None}, "'label' is missing"),
        ({"reader": object(), "suffixes": (".txt",)}, "no Reader"),
        ({"writer": object()}, "no Writer"),
        ({"patcher": object()}, "no Patcher"),
        ({"recorder": object()}, "no Recorder"),
        ({"reader": Language()}, "come together"),
        ({"suffixes": (".txt",)}, "come together"),
        ({"reader": Language(), "suffixes": ("txt",)}, "suffixes"),
        ({"reader": Language(), "suffixes": (".TXT",)}, "suffixes"),
        ({"reader": Language(), "suffixes": ".txt"}, "suffixes"),
        ({"companions": {"dat": "no"}}, "suffixes"),
        ({"emulation_only": {"arm-2": "no"}}, "arm-2"),
    ],
)
def test_a_vendor_checks_its_parts_at_birth(parts: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        vendor(parts.pop("name", "acme"), **parts)


def test_a_vendor_cannot_be_changed() -> None:
    one = vendor()
    with pytest.raises(AttributeError):
        one.name = "other"  # type: ignore[misc]
    with pytest.raises(TypeError):
        one.robots["arm-2"] = one.robots["arm-1"]  # type: ignore[index]


def test_the_motion_model_is_loaded_once() -> None:
    one = vendor()
    assert one.motion() is one.motion()


def test_a_missing_part_says_what_is_there() -> None:
    one = vendor(writer=Language())
    with pytest.raises(InputError, match=r"acme has no reader: .*labels, writer; build"):
        one.read_file("a.txt")
    with pytest.raises(InputError, match="acme has no patcher"):
        one.patch(None, {})  # type: ignore[arg-type]
    with pytest.raises(InputError, match="acme has no recorder"):
        one.record(Program(()), SimpleNamespace(name="acme/arm-1"), 0.004)  # type: ignore[arg-type]


def test_language_parts_are_reached_through_the_vendor() -> None:
    language = Language()
    one = vendor(
        reader=language,
        writer=language,
        suffixes=(".txt",),
        robots={"arm-1": lambda: None, "arm-2": lambda: None},
        emulation_only={"arm-2": "it speaks another language"},
    )
    robots: list[Any] = [SimpleNamespace(name=f"acme/arm-{i}") for i in (1, 2)]
    program = Program((), "p")
    assert one.read("x", "a.txt") == ("x", "a.txt", None, None)
    assert one.read_file("a.txt", "weld", robots[0]) == ("a.txt", "weld", robots[0])
    assert one.write(program, robots[0]) == {"main.txt": "p acme/arm-1 {}"}
    options = {"style": "terse"}
    assert one.write(program, robots[0], options) == {"main.txt": f"p acme/arm-1 {options}"}
    with pytest.raises(OptionError, match=r"answers are Answers, not dict: .*Answers\("):
        one.read_file("a.txt", answers={"di": 1})  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"acme/arm-2: it speaks another language.*emulated"):
        one.write(program, robots[1])
    with pytest.raises(InputError, match=r"acme/arm-2: it speaks another language.*emulated"):
        one.record(program, robots[1], 0.004)


def test_a_reader_is_found_by_suffix() -> None:
    language = Language()
    first = vendor("acme", reader=language, suffixes=(".txt", ".mod"))
    second = vendor("apex", reader=language, suffixes=(".txt",))
    registry = Registry({"acme": first, "apex": second})
    assert registry.reader_of("job/A.MOD") is first
    with pytest.raises(InputError, match=r"of acme and apex, .*choose a robot \(robot=acme/"):
        registry.reader_of("a.txt")
    with pytest.raises(InputError, match=r"a.src: no vendor reads '.src' files; known: .txt .mod"):
        registry.reader_of("a.src")


class Knowing(Language):
    """A reader that knows its texts by a word."""

    def __init__(self, word: str) -> None:
        self.word = word

    def recognises(self, text: str) -> bool:
        return self.word in text


def test_what_stands_in_a_file_tells_whose_it_is(tmp_path: Path) -> None:
    known = {"acme": Knowing("GO"), "apex": Knowing("RUN"), "third": Language()}
    registry = Registry({n: vendor(n, reader=r, suffixes=(".x",)) for n, r in known.items()})
    file = tmp_path / "a.x"
    for text, whose in (("GO 1", "acme"), ("RUN 1", "apex"), ("WALK", "third")):
        file.write_text(text, "utf-8")
        assert registry.reader_of(file).name == whose
    file.write_text("GO and RUN", "utf-8")
    with pytest.raises(InputError, match=r"a\.x: it may be of acme and apex, and nothing in it"):
        registry.reader_of(file)
    assert len(registry.readers_of(tmp_path / "absent.x")) == 3


def test_a_plain_text_is_of_another_vendor_if_that_knows_it_and_its_own_does_not(tmp_path) -> None:
    known = {"acme": Knowing("GO"), "apex": Knowing("RUN"), "third": Language()}
    ends = {"acme": (".txt", ".x"), "apex": (".y",), "third": (".z",)}
    registry = Registry({n: vendor(n, reader=r, suffixes=ends[n]) for n, r in known.items()})
    file = tmp_path / "a.txt"
    for text, whose in (("GO 1", "acme"), ("RUN 1", "apex"), ("GO, RUN", "acme"), ("", "acme")):
        for file in (tmp_path / "a.txt", tmp_path / "a.x"):
            file.write_text(text, "utf-8")
            expected = whose if file.suffix == ".txt" else "acme"
            assert registry.reader_of(file).name == expected


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("job.mod", "MODULE job\nPROC main()\nMoveJ p1,v100,fine,tool0;\nENDPROC\nENDMODULE\n"),
        ("job.mod", "  MoveL p1, v100, z10, tool0;\n"),
        ("job.src", "&ACCESS RVP\nDEF job()\nPTP HOME\nEND\n"),
        ("job.src", "GLOBAL DEF job( )\nEND\n"),
        ("job.script", "def job():\n  movej([0,0,0,0,0,0])\nend\n"),
        ("job.txt", "movel(p[0,0,0,0,0,0], a=1)\n"),
    ],
)
def test_a_stranger_takes_no_file_of_the_built_in_vendors(
    name: str, text: str, tmp_path: Path
) -> None:
    own = {v.name: v for v in vendors()}
    stranger = vendor("acme", reader=Language(), suffixes=(".mod", ".src", ".script", ".txt"))
    registry = Registry({**own, "acme": stranger})
    (tmp_path / name).write_text(text, "utf-8")
    assert registry.reader_of(tmp_path / name).name in ("abb", "kuka", "ur")
    (tmp_path / name).write_text("POINT a 1 2 3\nGO a\n", "utf-8")
    assert registry.reader_of(tmp_path / name) is stranger


def test_a_file_beside_a_program_says_what_to_name() -> None:
    one = vendor(
        reader=Language(), suffixes=(".txt",), companions={".dat": "name the .txt beside it"}
    )
    registry = Registry({"acme": one})
    with pytest.raises(InputError, match=r"^job/A\.DAT: name the \.txt beside it$"):
        registry.reader_of("job/A.DAT")
    with pytest.raises(InputError, match=r"'\.txt' is among 'suffixes' and 'companions'"):
        vendor(reader=Language(), suffixes=(".txt",), companions={".txt": "no"})


@pytest.mark.parametrize(("api", "remedy"), [(0, "newer plugin"), (99, "newer flyby")])
def test_a_plugin_built_for_another_interface_says_so(
    entry_point: Any, api: int, remedy: str
) -> None:
    module = ModuleType("old")

    @hookimpl
    def flyby_register_vendors(register: VendorRegister) -> None:
        register.add(vendor("old"), api=api)

    module.flyby_register_vendors = flyby_register_vendors  # type: ignore[attr-defined]
    registry = Registry.discover([entry_point("old", module), entry_point("new", plugin("new"))])
    assert f"version {api} of flyby's plugin interface" in str(broken(registry))
    assert remedy in str(broken(registry))
    assert sorted(registry.vendors) == ["new"]


def test_a_vendor_knows_what_it_was_installed_with(entry_point: Any) -> None:
    point = entry_point("acme", plugin("acme"))
    point.dist.version = "1.2"
    assert Registry.discover([point]).distributions == {"acme": "flyby-test 1.2"}
