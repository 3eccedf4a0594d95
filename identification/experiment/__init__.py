"""Designs test motions that tell how a controller drives, and writes them as programs that log."""
