"""Runs compared with expected values and tolerances: the format of the expectations, the comparison, accepting new
values, JUnit XML. Commands: `implam-compare` and `implam-regress`."""
