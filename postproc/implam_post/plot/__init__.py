"""Pictures of single runs with matplotlib: histories, energies, delamination and ply failures in plan, energy release
along fronts, movies, and files for ParaView. Commands: `implam-plot`, `implam-movie`, `implam-paraview`."""
