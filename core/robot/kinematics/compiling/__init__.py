"""The compiler of lean kernels: numba's, with what they need in few instructions."""
