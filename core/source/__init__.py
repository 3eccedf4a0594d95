"""Source files of robot programs: what the readers, writers and patchers of all vendors share."""
