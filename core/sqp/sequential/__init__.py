"""Sequential quadratic programming: one convex subproblem an iteration."""
