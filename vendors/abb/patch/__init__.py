"""Changed programs → the user's own RAPID files."""
