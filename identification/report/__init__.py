"""What a fit shows: pictures of runs beside their emulation, and the page that holds all."""
