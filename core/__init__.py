"""Robots, programs, motion and the interfaces that a vendor implements; knows no vendor."""
