"""Yaskawa for flyby: arms, how their controllers drive, and jobs (JBI)."""
