"""Several robots in one cell."""
