"""What commands print and write: tables, reports, notes, files."""
