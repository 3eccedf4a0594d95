"""Text of KRL → its syntax tree."""
