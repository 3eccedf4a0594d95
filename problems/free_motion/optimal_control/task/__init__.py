"""What is asked: the task, and limits and torques of the robot that it is asked of."""
