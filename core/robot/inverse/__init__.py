"""All configurations of an arm that take a pose, brought into the ranges of its joints."""
