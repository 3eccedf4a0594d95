"""Solids, and how far they are apart: closed forms and the libraries behind one interface."""
