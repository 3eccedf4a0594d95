from __future__ import annotations

import base64
import json
import math
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from flyby.core.errors import InputError
from flyby.drawing.page.content import (
    Page,
    PageRow,
    PageTable,
)
from flyby.drawing.page.html import page_html
from flyby.drawing.page.packing import Packer, Quantised, whole

from .unpacking import columns, content_of

NUMBERS = st.floats(-1e4, 1e4) | st.just(math.nan) | st.just(math.inf)


@given(
    arrays.arrays(np.float64, arrays.array_shapes(max_dims=2, max_side=30), elements=NUMBERS),
    st.sampled_from([1e-5, 1e-3, 0.37, 10.0]),
)
def test_numbers_come_back_within_half_a_step(values: np.ndarray, step: float) -> None:  # type: ignore[type-arg]
    packer = Packer()
    made = json.loads(packer.json(Quantised(values, step)))
    back = columns(zlib.decompress(base64.b64decode(packer.arrays())), made)
    known = np.isfinite(values)
    assert back.shape == values.shape
    assert (np.isfinite(back) == known).all()
    assert np.abs(back - values)[known].max(initial=0.0) <= 0.5 * step * (1 + 1e-6) + 1e-9


@given(st.lists(st.integers(-(2**30), 2**30), max_size=40))
def test_whole_numbers_are_exact(values: list[int]) -> None:
    packer = Packer()
    made = json.loads(packer.json(whole(values)))
    back = columns(zlib.decompress(base64.b64decode(packer.arrays())), made)
    assert back.tolist() == values


def test_numbers_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match="do not fit steps of 1e-09"):
        Packer().json(Quantised(np.array([0.0, 10.0]), 1e-9))


@given(st.text(st.characters(exclude_categories=()), max_size=60))
def test_no_text_ends_the_script_it_stands_in(text: str) -> None:
    hostile = f"{text}</script><script>alert(1)</script><!--"
    page = Page(hostile, "emulate", {hostile: hostile}, tables=[PageTable(hostile, [], [])])
    made = page_html(page)
    content, _ = content_of(made)
    assert "</script><script>alert" in content["title"]
    assert made.decode().count("<script") == 3 + made.decode().split("*/", 1)[1].count("<script")


def test_only_the_viewer_may_run() -> None:
    made = page_html(Page("a", "emulate")).decode()
    assert "script-src 'sha256-" in made
    assert "default-src 'none'" in made
    assert "script-src 'unsafe-inline'" not in made


def test_fields_that_hold_their_default_are_left_out() -> None:
    made = json.loads(Packer().json(PageRow(["a", 1.0, None, math.nan])))
    assert made == {"cells": ["a", 1.0, None, None]}
