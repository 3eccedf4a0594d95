"""Takes the logs that a robot sends, each into the file that its first line names.

Start it on the computer that ``flyby_host`` in the script names, before the program:

    python flyby_listen.py [FOLDER]

Each connection is one run: ``# NAME.csv``, then the lines of the log. Ctrl-C ends it.
"""

import contextlib
import re
import socket
import sys
from pathlib import Path
from typing import TextIO

PORT = 50010


def main(folder: Path, port: int = PORT) -> None:
    """Take one connection after the other."""
    folder.mkdir(parents=True, exist_ok=True)
    with socket.create_server(("", port)) as server:
        print(
            f"listening on port {server.getsockname()[1]}, logs go to {folder.resolve()}",
            flush=True,
        )
        while True:
            connection, address = server.accept()
            with connection, connection.makefile("r", encoding="ascii", errors="replace") as lines:
                take(lines, folder, address[0])


def take(lines: TextIO, folder: Path, sender: str) -> None:
    """Write one log."""
    first = lines.readline()
    named = re.fullmatch(r"# ([A-Za-z0-9][\w.-]*\.csv)\s*", first)
    if named is None:
        print(f"{sender} sent no log: it begins with {first[:40]!r}", flush=True)
        return
    count = -1  # the first line is the head
    path = folder / named[1]
    with path.open("w", encoding="ascii", errors="replace") as file:
        for line in lines:
            file.write(line)
            count += 1
    print(f"{path.name}: {max(count, 0)} samples", flush=True)


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
