"""The problem: its callables checked, scaled and differentiated."""
