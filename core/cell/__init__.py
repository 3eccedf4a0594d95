"""The cell: a robot with tools, frames, external axes and what stands around it."""
