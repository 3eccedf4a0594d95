"""RAPID's functions on strings and on the bits of bytes.

Positions count from 1; a search that finds nothing gives the string's length plus one. Bytes are
nums from 0 to 255; the functions on ``dnum`` take 52 bits.

Definitions: "RAPID Reference Manual", functions.
"""

from __future__ import annotations

import operator
from collections.abc import Callable

from .errors import WRONG_ARGUMENT
from .operators import STRING_LIMIT, OperandError
from .types import NUM, STRING, Type, Value

Computed = tuple[Callable[..., Value], tuple[Type | None, ...], tuple[str, ...]]
"""function, types of its required arguments (None: any), its optional arguments in order: nums, or
switches that are 1; 0 if they are absent."""

_BYTE = 8
_LONG = 52
_BASES = ((16, "x", 2), (8, "o", 3), (2, "b", 8))


def value_text(value: Value) -> str:
    """A value as ``ValToStr`` writes it."""
    return _shown(value)[:STRING_LIMIT]


def _shown(value: Value) -> str:
    if isinstance(value, tuple):
        return "[" + ",".join(_shown(v) for v in value) + "]"
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _number_text(value: float, decimals: float, exponent: float) -> str:
    digits = int(max(0.0, min(decimals, 15.0)))
    return f"{value:.{digits}E}" if exponent else f"{value:.{digits}f}"


def _part(text: str, position: float, length: float) -> str:
    start, count = int(position), int(length)
    if start < 1 or count < 0 or start - 1 + count > len(text):
        message = f"StrPart reaches outside a string of {len(text)} characters"
        raise OperandError(message, WRONG_ARGUMENT)
    return text[start - 1 : start - 1 + count]


def _place(text: str, position: float) -> int:
    start = int(position)
    if not 1 <= start <= len(text) + 1:
        message = f"position {start} is outside a string of {len(text)} characters"
        raise OperandError(message, WRONG_ARGUMENT)
    return start - 1


def _find(text: str, position: float, chosen: str, others: float) -> float:
    for index in range(_place(text, position), len(text)):
        if (text[index] in chosen) != bool(others):
            return index + 1.0
    return len(text) + 1.0


def _match(text: str, position: float, pattern: str) -> float:
    found = text.find(pattern, _place(text, position))
    return (found if found >= 0 else len(text)) + 1.0


def _member(text: str, position: float, chosen: str) -> bool:
    return text[_place(text, position) :][:1] in chosen and bool(text)


def _mapped(text: str, source: str, target: str) -> str:
    if len(source) != len(target):
        raise OperandError("StrMap takes two strings of equal length")
    return text.translate(str.maketrans(source, target))


def _ordered(first: str, second: str, order: str) -> bool:
    ranks = {character: rank for rank, character in enumerate(order)}
    keys = [[(ranks.get(c, len(order)), c) for c in text] for text in (first, second)]
    return keys[0] <= keys[1]


_RELATIONS = (operator.lt, operator.le, operator.eq, operator.ne, operator.ge, operator.gt)


def _compared(first: str, relation: float, second: str) -> bool:
    """``StrDigCmp``: positive whole numbers of any length; relations LT to GT are 1 to 6."""
    if not (first.isdecimal() and second.isdecimal() and 1 <= relation <= len(_RELATIONS)):
        raise OperandError("StrDigCmp takes strings of digits and a relation")
    return bool(_RELATIONS[int(relation) - 1](int(first), int(second)))


def _to_byte(text: str, *switches: float) -> float:
    hexadecimal, octal, binary, character = switches
    if character:
        return float(ord(text[:1] or "\0") & 0xFF)
    base = 16 if hexadecimal else 8 if octal else 2 if binary else 10
    return float(_byte(float(int(text, base))))


def _from_byte(value: float, *switches: float) -> str:
    byte = _byte(value)
    if switches[3]:
        return chr(byte)
    for switch, (_, letter, width) in zip(switches, _BASES, strict=False):
        if switch:
            return f"{byte:0{width}{letter}}".upper()
    return str(byte)


def _byte(value: float, bits: int = _BYTE) -> int:
    if value != int(value) or not 0 <= value < 2**bits:
        raise OperandError(f"{value:g} is no whole number of {bits} bits")
    return int(value)


def _bitwise(apply: Callable[[int, int], int], bits: int) -> Callable[[float, float], float]:
    def combined(a: float, b: float) -> float:
        return float(apply(_byte(a, bits), _byte(b, bits)) & (2**bits - 1))

    return combined


def _shifted(left: bool, bits: int) -> Callable[[float, float], float]:
    def shift(value: float, places: float) -> float:
        count = int(max(0.0, min(places, float(bits))))
        byte = _byte(value, bits)
        return float((byte << count if left else byte >> count) & (2**bits - 1))

    return shift


def _checked_bit(bits: int) -> Callable[[float, float], bool]:
    def check(value: float, position: float) -> bool:
        if not 1 <= position <= bits:
            raise OperandError(f"bits are numbered from 1 to {bits}, not {position:g}")
        return bool(_byte(value, bits) >> (int(position) - 1) & 1)

    return check


def _bits(bits: int, ending: str) -> dict[str, Computed]:
    two = (NUM, NUM)
    return {
        f"bitand{ending}": (_bitwise(operator.and_, bits), two, ()),
        f"bitor{ending}": (_bitwise(operator.or_, bits), two, ()),
        f"bitxor{ending}": (_bitwise(operator.xor, bits), two, ()),
        f"bitneg{ending}": (lambda v: float(~_byte(v, bits) & (2**bits - 1)), (NUM,), ()),
        f"bitlsh{ending}": (_shifted(True, bits), two, ()),
        f"bitrsh{ending}": (_shifted(False, bits), two, ()),
        f"bitcheck{ending}": (_checked_bit(bits), two, ()),
    }


TEXT_FUNCTIONS: dict[str, Computed] = {
    "numtostr": (_number_text, (NUM, NUM), ("exp",)),
    "dnumtostr": (_number_text, (NUM, NUM), ("exp",)),
    "valtostr": (value_text, (None,), ()),
    "strlen": (lambda s: float(len(s)), (STRING,), ()),
    "strpart": (_part, (STRING, NUM, NUM), ()),
    "strfind": (_find, (STRING, NUM, STRING), ("notinset",)),
    "strmatch": (_match, (STRING, NUM, STRING), ()),
    "strmemb": (_member, (STRING, NUM, STRING), ()),
    "strmap": (_mapped, (STRING, STRING, STRING), ()),
    "strorder": (_ordered, (STRING, STRING, STRING), ()),
    "strdigcmp": (_compared, (STRING, NUM, STRING), ()),
    "strtobyte": (_to_byte, (STRING,), ("hex", "okt", "bin", "char")),
    "bytetostr": (_from_byte, (NUM,), ("hex", "okt", "bin", "char")),
    "dectohex": (lambda s: f"{int(s):X}", (STRING,), ()),
    "hextodec": (lambda s: str(int(s, 16)), (STRING,), ()),
    **_bits(_BYTE, ""),
    **_bits(_LONG, "dnum"),
}
"""name → function; see `functions.COMPUTED`."""


def with_bit(value: float, position: float, on: bool) -> float:
    """A byte with a bit set or cleared (``BitSet``, ``BitClear``).

    Raises:
        OperandError: there is no such bit.
    """
    _checked_bit(_BYTE)(value, position)
    mask = 1 << (int(position) - 1)
    return float(int(value) | mask if on else int(value) & ~mask)
