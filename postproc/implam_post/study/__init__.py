"""Errors and processor times of a grid of methods (meshes, steps, integrators), with the Pareto front.
Command: `implam-study`."""
