"""URScript programs carried out: statements → the moves the robot makes."""
