"""Changed programs → the user's own URScript files."""
