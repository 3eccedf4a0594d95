"""Text of RAPID → its syntax tree."""
