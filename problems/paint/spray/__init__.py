"""The paint gun: its footprint, its trajectory, its outputs."""
