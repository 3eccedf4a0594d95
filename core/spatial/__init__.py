"""Rigid-body geometry: rotations and poses."""
