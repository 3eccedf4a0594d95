"""Linear algebra of the solver: patterns, factorisations, saddle-point systems."""
