"""Text of URScript → its syntax tree."""
