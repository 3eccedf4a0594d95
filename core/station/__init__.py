"""Several robots in one cell, each with its own program, on one clock."""
