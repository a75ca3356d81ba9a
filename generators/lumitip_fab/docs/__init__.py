"""Documents of a design: manual, bill of materials, wiring, and its figures beside the published
ones."""
