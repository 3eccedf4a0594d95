"""Arms of seven axes: the arm angle, and the configurations that have a given one."""
