"""Random stations of two robots, and what dense samples find there."""
