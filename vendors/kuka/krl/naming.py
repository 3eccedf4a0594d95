"""Names that KRL takes ("Quickguide KRL-Syntax", KSS 8: names)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import count

MAX_NAME = 24

_WORDS = """
    and b_and b_exor b_not b_or bool brake case cast_from cast_to ccclose ccopen channel char circ
    circ_rel confirm const continue cread cwrite c_dis c_ori c_ptp c_spl c_vel decl def default
    defdat deffct delay digin distance do else end enddat endfct endfor endif endloop endspline
    endswitch endwhile enum exit exor ext extfct false for frame global goto halt if import in int
    interrupt is lin lin_rel loop maximum minimum not off on onstart or out path pos priority prio
    private ptp ptp_rel ptp_spline public pulse real repeat resume return scirc scirc_rel sec signal
    slin slin_rel spl spl_rel spline sptp sptp_rel sread step stop_path struc swrite switch then
    time_block to trigger true until wait when while with axis e3axis e3pos e6axis e6pos load e
    """
RESERVED = frozenset(_WORDS.split())
"""Words of the language, in lower case."""

_DATA = """
    bas bas_command success pdat_act ldat_act fdat_act pdefault ldefault fdefault fhome xhome
    xhome1 xhome2 xhome3 xhome4 xhome5 home tool_data base_data load_data tool_name base_name
    machine_def last_basis p00 ext_pgno pgno pdat ldat fdat odat base_type ir_stopm
    """
CONTROLLER = frozenset(_DATA.split())
"""Names that every controller's own files hold, in lower case."""

_LEGAL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_OTHER = re.compile(r"[^A-Za-z0-9_]+")


class Names:
    """The names that a program has given out; upper and lower case are the same."""

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self._taken = {name.casefold() for name in taken} | RESERVED | CONTROLLER

    def claim(self, wanted: str, fallback: str) -> str:
        """``wanted`` if it is legal and free, else a legal and free name near to it.

        Args:
            wanted: any text; what may not stand in a name becomes ``_``.
            fallback: a legal name, taken if nothing of ``wanted`` can stand in a name.
        """
        stem = _OTHER.sub("_", wanted).strip("_") or fallback
        if not _LEGAL.fullmatch(stem):
            stem = f"{fallback}_{stem}"
        return self.first_free([stem[:MAX_NAME]], _numbered(stem))

    def first_free(self, *candidates: Iterable[str]) -> str:
        """The first of the candidates that is free; it is taken from now on."""
        for names in candidates:
            for name in names:
                if name.casefold() not in self._taken:
                    self._taken.add(name.casefold())
                    return name
        raise ValueError("no candidate is free")


def _numbered(stem: str) -> Iterator[str]:
    for k in count(2):
        suffix = f"_{k}"
        yield stem[: MAX_NAME - len(suffix)] + suffix
