"""Changed numbers of a generated script → the files of PolyScope."""
