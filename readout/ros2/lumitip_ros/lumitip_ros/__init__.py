"""A fingertip in ROS 2."""
