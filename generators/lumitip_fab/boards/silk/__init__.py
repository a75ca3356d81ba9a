"""The silkscreen of a board."""
