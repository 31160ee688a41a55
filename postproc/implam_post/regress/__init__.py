"""Comparison of runs with expected values and tolerances: file of expectations, comparison, acceptance of new values,
JUnit XML. Commands: `implam-compare` and `implam-regress`."""
