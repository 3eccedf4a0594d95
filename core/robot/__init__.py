"""Robots: kinematics, limits, dynamics and inverse kinematics of an arm with external axes."""
