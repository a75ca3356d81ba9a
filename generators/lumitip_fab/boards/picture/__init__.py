"""Pictures of a finished board, as it comes from the board house."""
