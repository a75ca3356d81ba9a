"""What is sent to a board house to have a board made and its parts placed."""
