"""Zone maximisation: every waypoint's zone as large as collisions and neighbours let it be."""
