"""A base for languages of one statement a line: labels, jumps, registers, calls, points."""
