"""Rays against triangles: a compiled tree of boxes, or Embree."""
