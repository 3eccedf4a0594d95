"""The options of tasks: each stated once, for the command line and for Python."""
