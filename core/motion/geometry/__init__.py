"""Where a path runs in closed form: segments, zones, and the curves of every channel over σ."""
