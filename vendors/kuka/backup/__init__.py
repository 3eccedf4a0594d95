"""Archives of KUKA controllers as they lie on disk."""
