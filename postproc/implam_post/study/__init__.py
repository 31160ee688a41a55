"""Error against processor time over a grid of methods (meshes, steps, integrators), with the Pareto front.
Command: `implam-study`."""
