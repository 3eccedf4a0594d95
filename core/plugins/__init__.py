"""What distributions add beside vendors, and how plugins are taken in."""
