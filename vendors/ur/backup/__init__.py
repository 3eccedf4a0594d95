"""What UR controllers keep: programs, installations, and folders of them."""
