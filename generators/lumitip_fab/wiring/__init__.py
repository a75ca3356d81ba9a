"""How the fingers are wired: list of cables, note and diagram."""
