"""Collisions in a cell: signed distances with gradients, contacts, and proof between samples."""
