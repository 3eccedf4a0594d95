"""What a KUKA's own data lists say of its arm: ``$machine.dat``, and ``$robcor.dat`` beside it."""

from .described import robot_of, stated_in, with_machine_data

__all__ = ["robot_of", "stated_in", "with_machine_data"]
