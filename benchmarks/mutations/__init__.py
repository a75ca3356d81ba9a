"""Damages built artefacts, by format and at random seeded places: do the checks see it?

`formats` has the mutators of each format, `sample` draws mutants so that every artefact has its
share, `trial` applies one to a copy of an output folder, runs the check modules that read the file,
and puts the file back.

A mutator takes the bytes of a file and a seeded generator, and returns other bytes and what it
did. It changes what the user of the file sees: a number by 2 % or more, a length by 0.2 mm or more,
never a comment, a name that nobody reads, or the rounding of a last digit. Where the place that it
drew has nothing to damage it raises `NotApplicableError`, and another one is drawn.
"""
