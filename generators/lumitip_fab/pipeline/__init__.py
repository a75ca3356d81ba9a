"""What is built from what, and what need not be built again."""
