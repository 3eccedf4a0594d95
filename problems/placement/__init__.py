"""Where a robot stands best for what its program does."""
