"""Programs carried from one vendor's robot to another's."""
