"""Emitter and receiver boards: circuit, placement, routing, pour, and the files to order them."""
