"""What kernels compute is what they compute as they are written."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numba import njit

from flyby.core.arrays import FloatArray, IntArray
from flyby.core.robot.kinematics.lean import inner, lean


class _Sheet(NamedTuple):
    """Arrays in a tuple in a tuple."""

    values: FloatArray
    counts: IntArray


class _Book(NamedTuple):
    left: _Sheet
    right: _Sheet
    chosen: np.ndarray


@inner
def _doubled(x: float) -> float:
    return 2.0 * x


@inner
def _taken(sheet: _Sheet, i: int, j: int) -> float:
    """One element; indices may count from the end."""
    return sheet.values[i, j] + sheet.counts[j]


@inner
def _noted(sheet: _Sheet, i: int, j: int, value: float) -> None:
    sheet.values[i, j] = value
    sheet.counts[j] += 1


@inner
def _turned(book: _Book) -> _Book:
    return _Book(book.right, book.left, book.chosen)


@lean
def _worked(book: _Book, at: IntArray, cube: FloatArray) -> tuple[float, float, int]:
    """Variables that change in loops, tuples made anew, elements of all kinds."""
    total, last, seen = 0.0, -1.0, 0
    own = book
    for k in range(at.size):
        i, j = at[k], at[-1 - k]
        if book.chosen[k]:
            own = _turned(own)
            seen += 1
        sheet = own.left if i < j else own.right
        value = _taken(sheet, i, j)
        if value > 1.0:
            value = _doubled(value) - 1
            last = value
        _noted(sheet, j, i, value)
        total += value + cube[i, -1, j] * book.left.values[0, 0]
        cube[i, 1, j] = total
        row = own.right.values[i]
        row[j] = 0.5 * row[j] + own.left.values.shape[1]
    return total, last, seen


def _made(numbers: FloatArray, counts: IntArray, chosen: np.ndarray) -> tuple[_Book, FloatArray]:
    left = _Sheet(numbers[0].copy(), counts[0].copy())
    right = _Sheet(numbers[1].copy(), counts[1].copy())
    return _Book(left, right, chosen), numbers.copy()


_NUMBERS = arrays(float, (3, 3, 3), elements=st.floats(-2, 2, width=32))
_COUNTS = arrays(np.int64, (2, 3), elements=st.integers(-3, 3))


@settings(deadline=None)
@given(_NUMBERS, _COUNTS, st.data())
def test_kernels_compute_what_is_written(numbers, counts, data) -> None:
    size = data.draw(st.integers(1, 6))
    chosen = data.draw(arrays(bool, size))
    at = data.draw(arrays(np.int64, size, elements=st.integers(-3, 2)))
    made = [_made(numbers, counts, chosen) for _ in range(2)]
    found = _worked(made[0][0], at, made[0][1])
    with np.errstate(over="ignore"):
        expected = _worked.py_func(made[1][0], at, made[1][1])
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)
    for side in range(2):
        for own, other in zip(made[0][0][side], made[1][0][side], strict=True):
            np.testing.assert_allclose(own, other, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(made[0][1], made[1][1], rtol=1e-12, atol=1e-12)


@inner
def _deep(x: FloatArray) -> float:
    return _doubled(x[0]) + _doubled(x[-1])


@inner
def _other(x: FloatArray) -> float:
    return _doubled(x[0]) * _deep(x)


@njit(error_model="numpy")
def _finished(x: FloatArray) -> float:
    return _deep(x) + x.copy()[0]


@njit(error_model="numpy")
def _mixed(x: FloatArray) -> float:
    y = x.copy()
    return _finished(y) + _other(y) + _worked_once(y)


@lean
def _worked_once(x: FloatArray) -> float:
    return _other(x) - _deep(x)


def test_kernels_that_make_arrays_call_others_and_what_those_have_taken_in() -> None:
    """Where one of them stands already that has taken in what it calls, the rest finds it."""
    x = np.array([1.0, 2.0, 3.0])
    deep, other = 8.0, 16.0
    assert _mixed(x) == deep + 1.0 + other + other - deep
    assert _worked_once(x) == other - deep


@inner
def _counted(low: int, high: int) -> int:
    """Loops of all kinds, one in another."""
    total = int(0.7 * low) + int(low < high) + int(high)
    for i in range(high):
        for j in range(low, high):
            total = 3 * total + i - j if i != j else total + 1
            if total > 1 << 40:
                total = 0
        for _ in range(2, 0):
            total += 1
        for j in range(high - 1, -1, -1):
            if j == low:
                break
            total += 2 * j
        for j in range(high, low, -3):
            total -= j
    for i in range(-3, high, 2):
        if i < low:
            continue
        total += 5 * i
    return total


@inner
def _looked_up(cube: FloatArray, numbers: FloatArray, low: int, high: int) -> float:
    """Elements and rows, from the start and from the end."""
    total = 0.0
    for i in range(-2, high):
        total = 0.5 * total + numbers[i] + cube[-1, i, 0] * cube[i][i, -i]
        plane = cube[i]
        line, last = plane[low], cube[-1][2]
        total += line[i] - last[-1] + plane[0, i] + line.size + plane.shape[1]
    for part in (total, numbers[0], 2.0):
        total += 0.5 * part
    for line in cube[0]:
        total += line[1]
    k = 0
    for i in range(high):
        k = k + i * 2
        total += numbers[k - i - i] + numbers[min(k, 2)] * cube[0, 1, 2]
    return total


@lean
def _numbers(
    cube: FloatArray, numbers: FloatArray, low: int, high: int
) -> tuple[int, float, float, float, float, int, bool]:
    count = _counted(low, high)
    a, b, c = numbers[0], numbers[1], numbers[2]
    least, most = min(a, b, c, 0), max(a, low, b)
    found = _looked_up(cube, numbers, low, high)
    power = a**2 + b**3 - c**1 + (a - b) ** 5
    quotient = a / b if b != 0 else a - low
    beyond = (a < b) != (b >= c) or a <= c or a > low or low == high
    return count, least, most, found + power, quotient, max(low, high) - min(low, 1), beyond


@settings(deadline=None)
@given(
    _NUMBERS, arrays(float, 3, elements=st.floats(-2, 2)), st.integers(-3, 2), st.integers(-3, 3)
)
def test_loops_rows_and_numbers_are_as_written(cube, numbers, low, high) -> None:
    found = _numbers(cube, numbers, low, high)
    with np.errstate(all="ignore"):
        expected = _numbers.py_func(cube, numbers, low, high)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


@settings(deadline=None)
@given(arrays(float, 3, elements=st.sampled_from([np.nan, np.inf, -np.inf, 1.0, -0.0, 0.0])))
def test_extremes_and_comparisons_of_what_is_no_number_are_as_written(numbers) -> None:
    cube = np.zeros((3, 3, 3))
    found = _numbers(cube, numbers, 1, 0)
    with np.errstate(all="ignore"):
        expected = _numbers.py_func(cube, numbers, 1, 0)
    np.testing.assert_array_equal(found, expected)


@inner
def _refused(x: float) -> float:
    if x < 0:
        raise ValueError("negative")
    return x


@lean
def _asked(x: FloatArray) -> float:
    total = 0.0
    for k in range(x.size):
        total += _doubled(_refused(x[k]))
    return total


def test_an_error_in_a_kernel_comes_out_of_its_callers() -> None:
    assert _asked(np.array([1.0, 2.0])) == 6.0
    with pytest.raises(ValueError, match="negative"):
        _asked(np.array([1.0, -2.0, 3.0]))


@lean
def _stepped(x: FloatArray, step: int) -> float:
    """A step that is not written as a literal."""
    total = 0.0
    for k in range(0, x.size, step):
        total += x[k]
    return total


def test_ranges_of_any_step() -> None:
    x = np.arange(5.0)
    assert [_stepped(x, step) for step in (1, 2, -1)] == [10.0, 6.0, 0.0]
    with pytest.raises(ValueError, match="zero"):
        _stepped(x, 0)


def test_arguments_of_another_type_are_refused() -> None:
    """Where Python calls the machine code, past numba's own look at what it is given."""
    numbers, counts = np.ones((2, 3, 3)), np.ones((2, 3), dtype=np.int64)
    at = np.array([0])

    def given() -> tuple[_Book, FloatArray]:
        return _made(numbers, counts, np.array([True]))

    (book, cube), (other, same) = given(), given()
    expected = _worked(book, at, cube)
    (compiled,) = (one.entry_point for one in _worked.overloads.values())
    assert compiled(other, at, same) == expected
    for wrong in (at.astype(np.int32), 3):
        with pytest.raises(TypeError, match="not of its type"):
            compiled(book, wrong, cube)
