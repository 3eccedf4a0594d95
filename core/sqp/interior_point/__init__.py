"""The primal–dual interior point for nonlinear programs."""
