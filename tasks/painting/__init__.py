"""The options of painting, and what it makes of them."""
