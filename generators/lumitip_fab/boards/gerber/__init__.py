"""What a board house makes a board from: Gerber X2 layers and Excellon drills."""
