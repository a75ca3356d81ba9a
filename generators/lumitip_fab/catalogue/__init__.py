"""The catalogue of parts in `design/parts/*.toml`: what a parameter file names by name."""
