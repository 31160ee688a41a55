"""Checks and plots of Implam's results; it shares no code with the solver, so that agreement means something."""
