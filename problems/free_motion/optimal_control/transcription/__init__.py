"""A task as a sparse nonlinear program."""
