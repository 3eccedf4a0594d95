"""The emulator put together: a program driven, and what is said of the run."""
