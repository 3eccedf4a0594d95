"""Errors that a program makes while it runs, which its ERROR handlers may take.

"RAPID Reference Manual", data type errnum: the names. Their numbers are not in any public text;
those given here only tell them apart, as programs do.
"""

from __future__ import annotations

from ....core.errors import Span, StopError

DIVISION_BY_ZERO = "err_divzero"
OUT_OF_BOUNDS = "err_outofbnd"
NOT_PRESENT = "err_notpres"
NO_ROUTINE = "err_refunkprc"
WRONG_ARGUMENT = "err_argvalerr"
OUT_OF_REACH = "err_roblimit"
TOO_LONG = "err_strtoolng"
TOO_MANY_RETRIES = "err_excrtymax"

LONG_JUMP = "long_jmp_all_err"
"""Stands for every error in the list of an ERROR handler."""

_NAMES = f"""{DIVISION_BY_ZERO} {OUT_OF_BOUNDS} {NOT_PRESENT} {NO_ROUTINE} {WRONG_ARGUMENT}
    {OUT_OF_REACH} {TOO_LONG} {TOO_MANY_RETRIES} {LONG_JUMP} err_acc_too_low
    err_activ_prof err_addr_inuse err_aliasio_def err_aliasio_type err_alrdycnt err_alrdy_moving
    err_ao_lim err_argdupcnd
    err_argname err_argnotper err_argnotvar err_array_size err_axis_act err_axis_ind
    err_axis_moving err_axis_par err_busstate err_bwdlimit err_calc_divzero err_calc_neg
    err_calc_overflow err_callio_inter err_callproc err_cam_busy err_cam_com_timeout
    err_cam_get_mismatch err_cam_maxtime err_cam_no_more_data err_cam_no_progmode
    err_cam_no_runmode err_cam_set_mismatch err_cfg_illtype err_cfg_ill_domain err_cfg_internal
    err_cfg_limit err_cfg_notfnd err_cfg_outofbounds err_cfg_writefile err_cntnotvar
    err_cnv_connect err_cnv_dropped err_cnv_not_act err_coll_stop err_comm_ext err_comm_init
    err_comm_init_failed err_conc_max err_contactl err_csv_index err_da_unkproc err_data_recv
    err_dev_maxtime err_diplag_lim err_drop_load err_execphr err_fileacc err_fileexist
    err_fileopen err_filesize err_filnotfnd err_fncnoret err_frame err_frictune_fatal
    err_glueflow err_go_lim err_hand_failedgrippos err_hand_failedmovepos err_hand_failedvacuum
    err_hand_notcalibrated err_illdim err_illquat err_illraise err_indcnv_order err_inoissafe
    err_inomax err_inpar_rdonly err_int_maxval err_int_notval err_invdim err_iodisable
    err_iodn_timeout err_ioenable err_ioerror err_itmsrc_undef err_linkref err_loaded
    err_loadid_fatal err_loadid_retry err_loadno_inuse err_loadno_nouse err_msg_pending
    err_maxintval err_module err_mod_not_loaded err_mod_notloaded err_mt_abort err_mt_home
    err_mt_homerun err_negarg err_name_invalid err_norununit err_notarr err_noteqdim
    err_notintval err_notsaved err_not_movetask err_no_aliasio_def err_no_sgun err_num_limit
    err_outside_reach err_overflow err_path err_pathdist err_path_stop err_perssupsearch
    err_pid_movestop err_pid_raise_pp err_ppa_timeout err_prgmemfull err_procsignal_off
    err_progstop err_ranybin_chk err_ranybin_eof err_rcvdata err_refunkdat err_refunkfun
    err_refunktrp err_rmq_dim err_rmq_full err_rmq_invalid err_rmq_invmsg err_rmq_msgsize
    err_rmq_name err_rmq_nomsg err_rmq_timeout err_rmq_value err_sc_write
    err_sgun_estop err_sgun_motoff err_sgun_negval err_sgun_notact err_sgun_notinit
    err_sgun_notopen err_sgun_notsync err_sig_name err_sigsupsearch err_sig_not_valid
    err_sock_addr_invalid err_sock_addr_inuse err_sock_closed err_sock_is_bound
    err_sock_is_conn err_sock_net_unreach err_sock_not_bound err_sock_not_conn
    err_sock_timeout err_sock_unspec err_speedlim_value err_speed_refresh_lim err_startmove
    err_store_prof err_symbol_type err_sym_access err_syncmoveoff err_syncmoveon err_syntax
    err_taskname err_tp_dibreak err_tp_dobreak err_tp_maxtime err_tp_no_client
    err_tp_persboolbreak err_trustlevel err_txtnoexist err_udpuc_comm err_uishow_fatal
    err_uishow_full err_ui_initvalue err_ui_maxmin err_ui_notint err_unit_par err_unkino
    err_unkproc err_unload err_use_prof err_waitsynctask err_wait_max err_wait_maxtime
    err_whl_search err_whlsearch err_wobj_moving"""

BOOKED = 90
"""Numbers that ``BookErrNo`` has to give: 1 to 90."""

NUMBERS = {name: BOOKED + 1.0 + place for place, name in enumerate(_NAMES.split())}
"""lower-case name → number."""


class ProgramError(StopError):
    """The program makes an error while it runs.

    Args:
        number: of the error, which ``ERRNO`` holds in a handler.

    Attributes:
        passed: the routine whose handler has passed it on.
    """

    def __init__(self, message: str, span: Span, number: float) -> None:
        super().__init__(message, span)
        self.number = number
        self.passed: object = None
