"""What the energy of an impact becomes, by the columns of the history. Usage: ledger.py [FOLDER]"""

from drawing import LIGHT, arrow, box, canvas, save

figure, axes = canvas(9.5, 4.6)
HELD = ["energy_kinetic\nplate in motion", "energy_strain\nelastic", "energy_indentation\ncontact, dent"]
TAKEN = ["energy_ply_damage\nfibres, matrix", "energy_delamination\ninterfaces", "energy_friction\nheat",
         "energy_contact\nsurfaces that meet", "energy_algorithmic\nintegrator, damping"]
box(axes, (0, 0), (3.0, 1.1), "energy_impactor\n(and work_external)", "#f6e3d8")
for k, text in enumerate(HELD):
    y = 1.7 - 1.7 * k
    box(axes, (5, y), (3.2, 1.1), text, LIGHT)
    arrow(axes, (1.5, 0), (3.4, y))
for k, text in enumerate(TAKEN):
    y = 2.6 - 1.3 * k
    box(axes, (10, y), (3.4, 1.05), text, "#e4dfee")
    arrow(axes, (6.6, 0.6 - 0.3 * k), (8.3, y))
axes.text(0, 3.6, "at the start", ha="center", weight="bold")
axes.text(5, 3.6, "held", ha="center", weight="bold")
axes.text(10, 3.6, "dissipated", ha="center", weight="bold")
axes.text(5, -3.7, "the sum of all columns, less work and initial energy, is energy_error", ha="center", style="italic")
axes.set_xlim(-1.8, 12)
axes.set_ylim(-3.9, 4)
save(figure, "ledger")
