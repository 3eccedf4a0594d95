"""Logged runs of real controllers, and what is learnt from them."""
