"""Opens what UR controllers keep: a folder of programs and installations, or one of these files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .marks import root_in, scripts_in

if TYPE_CHECKING:
    from ....core.backup.backup import Backup
    from ....core.robot.model import Robot


class Opener:
    """See `core.language.BackupOpener`; what opens is loaded when there is something to open."""

    def root_in(self, names: Sequence[str]) -> str | None:
        """See `marks.root_in`."""
        return root_in(names)

    def programs_in(self, names: Sequence[str]) -> str | None:
        """See `marks.scripts_in`."""
        return scripts_in(names)

    def unreadable_in(self, names: Sequence[str]) -> str | None:
        """None: nothing of this vendor's is known that could not be read."""
        return None

    def open(self, source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
        """The backup in a folder, or one file; see `BackupOpener.open`."""
        from .opening import opened

        return opened(source, root, find_robot)


OPENER = Opener()
