"""From a program to the path and the time-stamped trajectory that a controller would drive."""
