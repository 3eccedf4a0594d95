"""One HTML file with a cell, its program and the clock: what it shows as data, and the file."""
