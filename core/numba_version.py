"""Which numba is known from inside."""

LINKED = (0, 68)
"""The version of numba, major and minor, on whose inside `kinematics.compiling` and
`kernel_loading` build. With others kernels are compiled and loaded as numba does by itself: the
same code, which takes about twice as long to make, and a second or two to load."""
