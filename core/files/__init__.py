"""Files: read within bounds, written whole or not at all, tables read key by key."""
