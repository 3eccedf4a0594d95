"""Options and tasks that are typed otherwise than they are called in Python."""

from __future__ import annotations

from ...core.door import Shell

SHELL = Shell(
    flags={"answers": "--io", "others": "--with", "parameters": "--fit"},
    commands={"free_motion": "free"},
)
