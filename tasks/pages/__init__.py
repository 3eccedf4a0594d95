"""Pages of results: what each task shows in a browser, from one file."""
