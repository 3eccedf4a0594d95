"""Backups of ABB controllers (S4C+, IRC5, OmniCore), opened."""
