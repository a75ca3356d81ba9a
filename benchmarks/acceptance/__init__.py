"""Random designs within the ranges of `docs/ranges.md`: are they accepted at first try?

`generator` draws them, `limits` keeps to what can exist, `trial` derives and builds them, and
`confirm` judges each refusal without the code that refused.
"""
