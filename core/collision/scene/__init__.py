"""A cell with one tool mounted: bodies on frames, pairs that count, contacts and distances."""
