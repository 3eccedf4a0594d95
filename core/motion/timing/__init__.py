"""When the robot is where: limits as rows and ceilings, time parametrisation, rests."""
