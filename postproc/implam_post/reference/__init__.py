"""Closed-form and semi-analytic reference solutions: Navier's series for simply supported plates, and the impact of a
rigid sphere by modal superposition with an indentation law. Command: `implam-check-impact`."""
