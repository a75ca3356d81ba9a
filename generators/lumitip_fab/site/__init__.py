"""One page about an output folder, which opens by double click and needs no network.

folder    the files of an output folder that the page shows
cells     what belongs to each cell: parts, nets, wires, numbers
boards    boards as drawings with copper by net
masks     masks at 1:1, and the grid of cells
prints    printed parts
tables    bill, files, figures beside the publication
checks    every check with value, limit and margin
page      the page itself
"""
