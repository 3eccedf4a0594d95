"""Where figures come from: what is read is written, and what is malformed refused by its key."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.provenance import (
    FitRecord,
    Provenance,
    provenance_text,
    read_provenance,
)

WORD = st.text("ab \"'\\\n.é", min_size=1, max_size=8)
DETAILS = st.dictionaries(st.sampled_from(["runs", "loss", "a b"]), st.integers() | WORD)
FITS = st.builds(FitRecord, st.sampled_from("ab"), WORD, WORD, DETAILS)
NUMBERS = st.floats(-1e9, 1e9)
SOURCED = st.builds(Provenance, st.sampled_from(["published", "assumed"]), WORD, details=DETAILS)


@st.composite
def fitted(draw: st.DrawFn) -> Provenance:
    names = tuple(draw(st.lists(WORD, max_size=3)))
    intervals = tuple(tuple(sorted(draw(st.tuples(NUMBERS, NUMBERS)))) for _ in names)
    return Provenance("fitted", "", draw(FITS), names, intervals, draw(DETAILS))


def read(text: str) -> dict[str, Provenance]:
    data = tomllib.loads(text)
    return read_provenance(data.get("fits", {}), data.get("provenance", {}))


def nameless(origin: Provenance) -> Provenance:
    """Without the name of the fit, which is the file's own."""
    return origin if origin.fit is None else replace(origin, fit=replace(origin.fit, name=""))


@given(st.dictionaries(WORD, SOURCED | fitted(), max_size=6))
def test_what_is_written_is_read(origins: dict[str, Provenance]) -> None:
    made = read(provenance_text(origins))
    for key, origin in origins.items():
        assert nameless(made[key]) == nameless(origin)
    # Each fit is described once, whatever figures came of it.
    assert len({id(one.fit) for one in made.values() if one.fit}) == len(
        {repr(one.fit) for one in origins.values() if one.fit}
    )
    assert read(provenance_text(made)) == made


FIT = "[fits.one]\nsource = 's'\ncommand = 'c'\n"
WRONG = {
    "[fits]\none = 3": r"fits\.one: a table",
    "[fits.one]\ncommand = 'c'": r"fits\.one: the source is missing",
    "[fits.one]\nsource = 's'": r"fits\.one: the command is missing",
    "[fits.one]\nsource = ['s']\ncommand = 'c'": r"fits\.one: source: a text",
    "[provenance]\nx = 3": r"provenance\.x: a table",
    "[provenance]\nx = { source = 's' }": r"provenance\.x: the status is missing",
    "[provenance]\nx = { status = 3 }": r"provenance\.x: status: a text",
    "[provenance]\nx = { status = 'guessed', source = 's' }": r"provenance\.x: unknown status",
    "[provenance]\nx = { status = 'assumed' }": r"provenance\.x: the source is missing",
    "[provenance]\nx = { status = 'fitted', source = 's' }": r"provenance\.x: .*by = ",
    "[provenance]\nx = { status = 'fitted', by = 'one' }": r"provenance\.x: unknown fit.*'one'",
    f"{FIT}[fits.one.range]\nspeed = [0, 1]": r"fits\.one\.range: unknown key of a range",
    f"{FIT}[fits.one.range]\nspeed_mps = [2, 1]": r"fits\.one\.range: speed_mps: ",
    f"{FIT}[fits.one.range]\nzone_m = [1]": r"fits\.one\.range: zone_m: two numbers",
    f"{FIT}[fits.one.range]\nleg_m = 0": r"fits\.one\.range: leg_m: ",
    f"{FIT}[fits.one.range]\nmoves = ['MoveX']": r"fits\.one\.range: unknown kind of moves",
    f"{FIT}[fits.one.range]\nstops = 1": r"fits\.one\.range: stops: true or false",
    f"{FIT}[fits.one.range]\njoints_rad = [[0, 1], [1]]": r"fits\.one\.range: joints_rad: ",
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'on' }}": r"did you mean 'one'",
    f"{FIT}[provenance]\nx = {{ status = 'assumed', by = 'one', source = 's' }}": r"\.x: .*by = ",
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'one', source = 's' }}": "said by its fit",
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'one', fitted = 'k' }}": r"x: fitted: a l",
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'one', fitted = [1] }}": r"x: fitted: a l",
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'one', interval = [[0, 1]] }}": (
        "1 intervals of 0"
    ),
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'one', interval = [[1, 0]] }}": "pairs",
    f"{FIT}[provenance]\nx = {{ status = 'fitted', by = 'one', interval = [[0, 'a']] }}": "pairs",
}


@pytest.mark.parametrize("text", WRONG)
def test_what_is_malformed_is_named(text: str) -> None:
    with pytest.raises(InputError, match=WRONG[text]):
        read(text)


def test_fits_of_one_name_are_told_apart() -> None:
    origins = {
        key: Provenance("fitted", fit=FitRecord("logs", source, "c"))
        for key, source in (("x", "mine"), ("y", "the vendor's"), ("z", "mine"))
    }
    made = read(provenance_text(origins))
    assert [made[key].fit.name for key in "xyz" if made[key].fit] == ["logs", "logs-2", "logs"]


ONE, OTHER, THIRD = (Provenance("assumed", word) for word in ("one", "other", "third"))


def test_one_row_stands_for_all_figures_that_have_none() -> None:
    rows = {"*": ONE, "blend.*": OTHER, "blend.tcp.kind": THIRD}
    model = MotionModel(provenance=rows)
    assert set(model.provenance) == model.figures
    assert model.provenance["period_s"] is ONE
    assert model.provenance["blend.joint.kind"] is OTHER
    assert model.provenance["blend.tcp.kind"] is THIRD
    assert MotionModel(provenance=dict(reversed(rows.items()))).provenance == model.provenance
    # A figure that is stated later has no provenance by itself.
    later = replace(model, zone_time=0.01)
    assert later.figures - later.provenance.keys() == {"zone.least_time_s"}


def test_one_row_of_a_file_is_of_the_figures_that_it_states(tmp_path: Path) -> None:
    base = MotionModel(provenance={"*": ONE})
    file = tmp_path / "one.toml"
    file.write_text(
        "period_s = 0.01\n[zone]\nleast_time_s = 0.02\n"
        '[provenance]\n"*" = { status = "assumed", source = "other" }\n'
    )
    made = load_motion_model(file, base)
    assert made.provenance == {**base.provenance, "period_s": OTHER, "zone.least_time_s": OTHER}
    assert set(load_motion_model(file).provenance) == load_motion_model(file).figures
