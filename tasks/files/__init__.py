"""What tasks write: texts of programs, read back, and files, all of a set or none."""
