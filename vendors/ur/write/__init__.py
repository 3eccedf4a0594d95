"""Programs → URScript."""
