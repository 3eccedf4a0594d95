"""PolyScope's own files: programs (``.urp``), installations, and what they say of the arm."""
