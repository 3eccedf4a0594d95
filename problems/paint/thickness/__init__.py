"""Trajectories for an even coat: the best speeds along a path, and the whole trajectory."""
