"""Closed-form and semi-analytic solutions that runs are checked against: Navier's series for simply supported plates,
the impact of a rigid sphere by modal superposition with an indentation law, and the command `implam-check-impact`."""
