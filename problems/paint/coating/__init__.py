"""The coat that a trajectory leaves, its derivatives, and what it is worth."""
