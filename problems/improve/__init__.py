"""Programs that a controller drives, improved: zones, via points, speeds; time and energy."""
