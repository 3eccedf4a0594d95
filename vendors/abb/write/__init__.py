"""Programs → RAPID."""
