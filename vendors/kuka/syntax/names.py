"""Names that KRL takes ("Quickguide KRL-Syntax", KSS 8: names)."""

from __future__ import annotations

from ....core.source.text.names import NameRules

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

NAME_RULES = NameRules(RESERVED | CONTROLLER, MAX_NAME)
