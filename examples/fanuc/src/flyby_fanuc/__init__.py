"""FANUC for flyby: arms, how R-30iB controllers drive, and TP programs as text (``.ls``)."""
