"""The build manual: one text made from the design and the files beside it, as HTML and PDF."""
