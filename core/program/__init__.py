"""Robot programs as immutable values in SI units: targets, speeds, zones, moves."""
