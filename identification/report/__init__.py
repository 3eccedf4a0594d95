"""What a log and its emulation show beside each other: corners, pictures."""
