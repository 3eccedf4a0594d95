"""Two states of a program or a station side by side."""
