"""Proof that two robots, each driving its own program, keep a clearance to each other."""
