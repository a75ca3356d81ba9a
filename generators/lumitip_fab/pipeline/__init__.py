"""Build graph, dependencies and the manifest of an output folder."""
