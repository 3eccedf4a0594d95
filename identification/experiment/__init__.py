"""Designs test motions that show how a controller drives, and writes them as programs that log."""
