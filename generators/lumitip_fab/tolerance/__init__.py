"""Tolerances: how many fingers meet the goals as they are built.

options   settings and their limits
streams   random numbers from one seed
draws     deviations of built fingers, from the catalogue's distributions
estimate  the pose estimator on many frames at once
bench     errors of fingers as built, after a tare, after self-calibration
sobol     which deviation matters
study     yield, percentiles, sensitivities, and how far a mask may be off
report    tables, JSON and picture
"""
