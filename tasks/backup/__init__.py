"""Backups of stations: opened, read, and as files of this software."""
