"""Which configuration an arm takes at the targets of moves, and what is said of it."""
