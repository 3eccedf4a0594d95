"""First paths, from start to goal round everything that stands in the way (OMPL)."""
