"""Differences of two designs, from their output folders.

folder    an output folder, read and tested
values    parameters, facts, bill and files
checks    checks that pass in one alone, and margins that changed
solids    volumes of the printed parts that only one has
render    pictures of solids
copper    copper that only one has, by board and layer
report    everything together: the lines of a summary, and JSON
page      one HTML page
"""
