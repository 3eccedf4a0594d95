"""Which way a run goes: branches, loops and jumps."""
