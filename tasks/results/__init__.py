"""What tasks hand out: tables, pictures and files of their results."""
