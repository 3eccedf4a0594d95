"""What tasks can be told: every option stated once, for the command line and for Python."""
