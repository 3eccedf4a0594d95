"""Backups of controllers as they lie on disk: robots, tasks, data, signals."""
