"""Opens archives of KUKA controllers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .marks import of_iiqka, of_workvisual, programs_in, root_in

if TYPE_CHECKING:
    from ....core.backup.backup import Backup
    from ....core.robot.model import Robot


class Opener:
    """See `core.language.BackupOpener`; what opens is loaded when there is something to open."""

    def root_in(self, names: Sequence[str]) -> str | None:
        """See `marks.root_in`."""
        return root_in(names)

    def programs_in(self, names: Sequence[str]) -> str | None:
        """See `marks.programs_in`."""
        return programs_in(names)

    def unreadable_in(self, names: Sequence[str]) -> str | None:
        """See `marks.of_iiqka` and `marks.of_workvisual`."""
        named, project = of_iiqka(names), of_workvisual(names)
        if named is None and project is not None:
            return (
                f"{project} is a project of WorkVisual, in a form that it alone reads: save the "
                "controller's archive, or a folder with KRC/R1, from WorkVisual or at the pendant"
            )
        if named is None:
            return None
        return (
            f"{named} is of KUKA's iiQKA.OS, by its name: how that keeps programs and machine data "
            "is not known here; what is read are archives with KRC/R1 in them (.src, .dat, "
            "$machine.dat), and single programs in KRL"
        )

    def open(self, source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
        """The archive in a folder; see `BackupOpener.open`."""
        from .opening import opened

        return opened(source, root, find_robot)


OPENER = Opener()
