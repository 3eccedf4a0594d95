"""Pictures: paths and speeds of runs, cells and robots in space."""
