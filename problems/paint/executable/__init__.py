"""From a painting trajectory to a program that a robot drives, and the coat that it then leaves."""
