"""Convex quadratic subproblems and the back ends that solve them."""
