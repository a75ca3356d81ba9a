"""The black print on the inside of the film: artwork, and its paper, drawing and cutting files."""
