"""Programs driven as far as they can be: past the moves that cannot be driven."""
