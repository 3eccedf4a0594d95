"""Suffixes of KRL's files: of programs, and of what belongs to them."""

PROGRAMS = (".src", ".sub")
COMPANIONS = {
    ".dat": "a data list drives no robot: read the .src of the same name, which takes its .dat "
    "with it"
}
"""Suffix of files that are no programs → what to read instead."""
