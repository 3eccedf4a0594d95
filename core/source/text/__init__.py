"""Source texts: files and places in them, tokens, names, numbers."""
