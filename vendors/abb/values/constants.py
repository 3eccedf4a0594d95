"""Constants that every controller knows by name beside `predefined`.

"RAPID Reference Manual": data types dionum, errnum, btnres, buttondata, symnum, opnum and the
predefined string data of StrFind. Constants whose numbers no public text states are not here; they
are compared with nothing but values that are not known either.
"""

from __future__ import annotations

import string
from collections.abc import Mapping
from types import MappingProxyType

from .types import NUM, STRING, Type, Value


def _numbers(**values: float) -> dict[str, tuple[Type, Value]]:
    return {name: (NUM, float(value)) for name, value in values.items()}


def _counted(names: str, first: int = 0) -> dict[str, tuple[Type, Value]]:
    return _numbers(**{name: first + i for i, name in enumerate(names.split())})


USER_NUMBERS = ("reg1", "reg2", "reg3", "reg4", "reg5")
USER_CLOCK = "clock1"
"""Variables that the system module ``user`` of every new controller declares."""

CONSTANTS: Mapping[str, tuple[Type, Value]] = MappingProxyType(
    {
        **_numbers(pi=3.141592653589793, low=0, high=1, edge=2, eof_num=9.998e36, eof_bin=-1),
        **_counted("run_undef run_cont_cycle run_instr_fwd run_instr_bwd run_sim run_step_move"),
        **_counted("op_undef op_auto op_man_prog op_man_test"),
        **_counted("resunkwn resok resabort resretry resignore rescancel resyes resno"),
        **_counted("btnok btnabrtrtryign btnokcancel btnretrycancel btnyesno btnyesnocancel"),
        **_numbers(btnnone=-1),
        **_counted("iconnone iconinfo iconwarning iconerror"),
        **_counted("lt lteq eq noteq gteq gt", 1),
        "str_digit": (STRING, string.digits),
        "str_lower": (STRING, string.ascii_lowercase),
        "str_upper": (STRING, string.ascii_uppercase),
        "str_white": (STRING, " \t\r\n"),
    }
)
"""lower-case name → type and value."""
