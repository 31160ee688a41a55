"""The loop of an implicit and of an explicit step. Usage: step_loop.py [FOLDER]"""

from drawing import GREEN, INK, LIGHT, RED, arrow, box, canvas, save

figure, axes = canvas(15, 5.6)
IMPLICIT = [
    "first guess from the accepted state",
    "residual r: internal, inertia, impact, contact",
    "tangent J; GMRES with the lagged factor",
    "contact force, line search, u = u + du",
    "contact multipliers; fronts grow?",
    "accept: plies, ledger, output",
]
EXPLICIT = [
    "stable step",
    "velocities by element forces",
    "each node: openings, shears, friction",
    "displacements, damage of interfaces",
    "impactor, contact force",
    "element forces, damage of plies",
    "accept: ledger, output",
]


def column(x, title, texts):
    """Boxes below each other; returns the heights of their centres."""
    axes.text(x, 0.9, title, ha="center", weight="bold")
    heights = [-1.1 * k for k in range(len(texts))]
    for k, (y, text) in enumerate(zip(heights, texts, strict=True)):
        box(axes, (x, y), (7.0, 0.8), text, "#dff0e0" if k == len(texts) - 1 else LIGHT)
        if k:
            arrow(axes, (x, y + 0.75), (x, y + 0.35))
    return heights


def back(x, start, end, text, colour, side):
    """A way back beside a column."""
    edge = x + (3.5 if side > 0 else -3.5)
    out = edge + side * 0.5
    axes.plot([edge, out, out], [start, start, end], color=colour, lw=1.4)
    arrow(axes, (out, end), (edge, end), colour)
    axes.text(out + side * 0.1, (start + end) / 2, text, color=colour, fontsize=9, va="center",
              ha="left" if side > 0 else "right")


y = column(0, "implicit step", IMPLICIT)
back(0, y[3] - 0.12, y[1], "|r| above\ntolerance", RED, -1)
back(0, y[4], y[1], "pressures not settled,\nfront grows", RED, 1)
back(0, y[5] - 0.1, y[0], "next step", GREEN, -6)
axes.text(0, y[5] - 0.75, "not converged: half the step length", ha="center", fontsize=9, color=RED)
y = column(14.5, "explicit step", EXPLICIT)
back(14.5, y[6], y[0], "next step", GREEN, 1)
axes.text(14.5, y[6] - 0.75, "no iteration over the plate", ha="center", fontsize=9, color=INK)
axes.set_xlim(-10, 21)
axes.set_ylim(-7.8, 1.4)
save(figure, "step_loop")
