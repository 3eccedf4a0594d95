"""Code that uses a changed datum, or drives under a changed setting, and was not executed."""
