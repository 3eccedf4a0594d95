"""Exact derivatives of driven programs, pulled back along the steps of the emulator."""
