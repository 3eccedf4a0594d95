"""Parts that are picked and placed: which a program carries on each move, where the others lie."""
