"""How fingers, gripper, robot and boards are held together."""
