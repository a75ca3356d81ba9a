"""Acceptance of a finished pair of fingers: a protocol with a printed gauge, and its verdict.

gauge      the gauge's placements, from `gauge.json`
steps      what the builder does, and the frames of each step
response   values that fingers with some deviations read of the gauge
fit        the deviations that explain the measured values
verdict    limits, findings, and corrections for the robot
report     JSON and HTML
"""
