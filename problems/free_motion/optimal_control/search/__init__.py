"""The outer iteration: linearise, solve, prove, refine."""
