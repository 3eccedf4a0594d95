"""What differs between two programs: data, moves, texts, driven paths."""
