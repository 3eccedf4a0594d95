"""Changes in a user's own files: who reads a number, and edits that are proven."""
