"""The finger: cells, layers, outline."""
