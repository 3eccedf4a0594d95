"""Programs → KRL."""
