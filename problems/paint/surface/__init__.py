"""The part to be painted: its triangles, where they come from, and rays against them."""
