"""What writers share: options, the approach, kept statements, reading back."""
