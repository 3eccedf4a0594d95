"""What painting can be told, and what it makes of that."""
