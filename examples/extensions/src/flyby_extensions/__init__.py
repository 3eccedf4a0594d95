"""What a distribution can add to flyby beside a vendor."""
