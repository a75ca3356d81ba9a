"""A study of designs: parameters are varied, and every design is judged before anything is built.

vary      what is varied, and the designs that come of it
evaluate  one design: accuracy, cells, size, cost, current; or why it is refused
journal   what is known already, so that a study goes on where it was stopped
run       all designs, on this machine or on a cluster
report    table, front and plot
"""
