"""Data that every controller knows without a declaration: speeds, zones, the flange, the world.

The numbers are those of the "RAPID Reference Manual", data types speeddata, zonedata, tooldata,
wobjdata and loaddata, as three public tools carry them alike (RobotComponents; rpiRobotics
abb_motion_program_exec; a RAPID generator that cites the manual). Stop points have the times of
their names.

RAPID does not tell upper from lower case: every table has lower-case keys, and the look-ups
take a name in any case.

Constants: data types dionum, errnum, btnres, buttondata, symnum, opnum and the predefined string
data of StrFind. Of handler_type, event_level, event_type and errnum the numbers only tell the
names apart. Those whose numbers no public text states are not here; they are compared with nothing
but values that are not known either.
"""

from __future__ import annotations

import string
from collections.abc import Mapping
from types import MappingProxyType

from ....core.program.speed import Speed
from ....core.program.tool import FLANGE, WORLD
from ....core.program.zone import Zone
from .errors import NUMBERS
from .records import LOAD0, VMAX, Record, speed_value, tool_record, work_object_record, zone_value
from .types import NUM, STRING, Type, Value

_V_TCP = (
    *(5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000),
    *(1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000),
)

SPEEDS: Mapping[str, Record] = MappingProxyType(
    {
        **{f"v{v}": (float(v), 500.0, 5000.0, 1000.0) for v in _V_TCP},
        "vmax": VMAX,
    }
)
"""name → ``[v_tcp, v_ori, v_leax, v_reax]`` in mm/s and deg/s."""

_EXTERNAL = MappingProxyType(
    {f"vrot{v}": (*VMAX[:3], float(v)) for v in (1, 2, 5, 10, 20, 50, 100)}
    | {f"vlin{v}": (*VMAX[:2], float(v), VMAX[3]) for v in (10, 20, 50, 100, 200, 500, 1000)}
)
"""Speeds for external axes alone: name → record, of which that component counts."""

ZONES: Mapping[str, Record] = MappingProxyType(
    {
        "fine": (True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        "z0": (False, 0.3, 0.3, 0.3, 0.03, 0.3, 0.03),
        "z1": (False, 1.0, 1.0, 1.0, 0.1, 1.0, 0.1),
        "z5": (False, 5.0, 8.0, 8.0, 0.8, 8.0, 0.8),
        "z10": (False, 10.0, 15.0, 15.0, 1.5, 15.0, 1.5),
        "z15": (False, 15.0, 23.0, 23.0, 2.3, 23.0, 2.3),
        "z20": (False, 20.0, 30.0, 30.0, 3.0, 30.0, 3.0),
        "z30": (False, 30.0, 45.0, 45.0, 4.5, 45.0, 4.5),
        "z40": (False, 40.0, 60.0, 60.0, 6.0, 60.0, 6.0),
        "z50": (False, 50.0, 75.0, 75.0, 7.5, 75.0, 7.5),
        "z60": (False, 60.0, 90.0, 90.0, 9.0, 90.0, 9.0),
        "z80": (False, 80.0, 120.0, 120.0, 12.0, 120.0, 12.0),
        "z100": (False, 100.0, 150.0, 150.0, 15.0, 150.0, 15.0),
        "z150": (False, 150.0, 225.0, 225.0, 23.0, 225.0, 23.0),
        "z200": (False, 200.0, 300.0, 300.0, 30.0, 300.0, 30.0),
    }
)
"""name → ``[finep, pzone_tcp, pzone_ori, pzone_eax, zone_ori, zone_leax, zone_reax]`` in mm and
deg."""

STOP_TIME, FOLLOW_TIME = 2.0, 3.0
"""Types of stop points at which the robot stands for a time, beside those by position (1)."""


def _stop(kind: float, part: float, stop: float = 0.0, follow: float = 0.0) -> Record:
    inside = (part, part, 0.0, 2.0) if part else (0.0,) * 4
    return kind, kind == 1.0, inside, stop, follow, "", 0.0, 0.0


_TIMES = {"0_5": 0.5, "1_0": 1.0, "1_5": 1.5}
STOPS: Mapping[str, Record] = MappingProxyType(
    {
        **{f"inpos{part}": _stop(1.0, part) for part in (20, 50, 100)},
        **{f"stoptime{name}": _stop(STOP_TIME, 0.0, stop=s) for name, s in _TIMES.items()},
        **{f"fllwtime{name}": _stop(FOLLOW_TIME, 0.0, follow=s) for name, s in _TIMES.items()},
    }
)
"""name → ``[type, progsynch, inpos, stoptime, followtime, signal, relation, checkvalue]``, s."""

RECORDS: Mapping[str, Mapping[str, Record]] = MappingProxyType(
    {
        "speeddata": MappingProxyType({**SPEEDS, **_EXTERNAL}),
        "zonedata": ZONES,
        "stoppointdata": STOPS,
        "tooldata": MappingProxyType({FLANGE.name: tool_record(FLANGE)}),
        "wobjdata": MappingProxyType({WORLD.name: work_object_record(WORLD)}),
        "loaddata": MappingProxyType({"load0": LOAD0}),
    }
)
"""data type → name → record: everything that needs no declaration."""

NAMES = frozenset(name for records in RECORDS.values() for name in records)


def _numbers(**values: float) -> dict[str, tuple[Type, Value]]:
    return {name: (NUM, float(value)) for name, value in values.items()}


def _counted(names: str, first: int = 0) -> dict[str, tuple[Type, Value]]:
    return _numbers(**{name: first + i for i, name in enumerate(names.split())})


ERRNO = "errno"
"""What error a handler is run for; the run keeps it."""

USER_NUMBERS = ("reg1", "reg2", "reg3", "reg4", "reg5")
USER_CLOCK = "clock1"
"""Variables that the system module ``user`` of every new controller declares."""

CONSTANTS: Mapping[str, tuple[Type, Value]] = MappingProxyType(
    {
        **_numbers(pi=3.141592653589793, low=0, high=1, edge=2, eof_num=9.998e36, eof_bin=-1),
        **_counted("inpos stoptime fllwtime", 1),
        **_counted("run_undef run_cont_cycle run_instr_fwd run_instr_bwd run_sim run_step_move"),
        **_counted("op_undef op_auto op_man_prog op_man_test"),
        **_counted("resunkwn resok resabort resretry resignore rescancel resyes resno"),
        **_counted("btnok btnabrtrtryign btnokcancel btnretrycancel btnyesno btnyesnocancel"),
        **_numbers(btnnone=-1),
        **_counted("iconnone iconinfo iconwarning iconerror"),
        **_counted("lt lteq eq noteq gteq gt", 1),
        **_counted("handler_none handler_bwd handler_err handler_undo"),
        **_counted("level_normal level_trap level_service"),
        **_counted("event_none event_poweron event_start event_stop event_qstop event_restart"),
        **_numbers(**NUMBERS),
        **_counted(
            "socket_created socket_connected socket_bound socket_listening socket_closed", 1
        ),
        **_numbers(wait_max=9999999),
        "stempty": (STRING, ""),
        "str_digit": (STRING, string.digits),
        "str_lower": (STRING, string.ascii_lowercase),
        "str_upper": (STRING, string.ascii_uppercase),
        "str_white": (STRING, " \t\r\n"),
    }
)
"""lower-case name → type and value."""

_SPEED_VALUES = {name: speed_value(record, name) for name, record in SPEEDS.items()}
_ZONE_VALUES = {name: zone_value(record, name) for name, record in ZONES.items()}


def speed(name: str) -> Speed | None:
    """The predefined speed called ``name``, None if there is none."""
    return _SPEED_VALUES.get(name.casefold())


def zone(name: str) -> Zone | None:
    """The predefined zone called ``name``, None if there is none."""
    return _ZONE_VALUES.get(name.casefold())
