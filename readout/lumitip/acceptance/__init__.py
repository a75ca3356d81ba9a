"""Acceptance of a finished pair of fingers: a protocol with a printed gauge, and its verdict.

gauge      the gauge's placements, from `gauge.json`
steps      the builder's steps, and the frames of each
response   values that fingers with some deviations read of the gauge
spread     how single parts, boards and drift change them
fit        the deviations that explain the measured values
places     swapped cells, from a sheet that moves
stage      how exactly the edge of a sheet is found that a positioning stage moves
findings   limits of what is judged
cells      findings of single cells
fingers    findings of the fingers as a whole
verdict    the judge
page       the report as HTML
report     its files
"""
