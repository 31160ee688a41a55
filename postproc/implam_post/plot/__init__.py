"""Pictures of runs: histories, energies, delamination and ply failures in plan, energy release rates along fronts;
movies, and files for ParaView. Commands: `implam-plot`, `implam-movie`, `implam-paraview`."""
