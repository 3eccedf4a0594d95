"""Convex parts of meshes."""
