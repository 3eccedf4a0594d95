"""Kinematics of an arm: the chain from work object to TCP, its derivatives and bounds, and back."""
