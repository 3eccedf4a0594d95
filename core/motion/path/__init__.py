"""Waypoints and whole paths: configurations, and curves sampled through inverse kinematics."""
