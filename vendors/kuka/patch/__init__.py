"""Changed programs → the user's own KRL files."""
