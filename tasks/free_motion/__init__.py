"""The free robot: how fast it could go if no program language stood in the way."""
