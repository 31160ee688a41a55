"""Axes, plies and signs of a plate that is struck. Usage: coordinates.py [FOLDER]"""

from drawing import BLUE, GREY, INK, LIGHT, RED, arrow, canvas, plt, save

# A plate seen from above one edge: x to the right, y backwards, z downwards.
BACK = (0.9, 0.55)


def at(x, y, z):
    """Place in the picture."""
    return x + BACK[0] * y, BACK[1] * y - z


figure, axes = canvas(8, 4)
angles = (0, 45, -45, 90)
for ply, angle in enumerate(angles):
    top, bottom = 0.3 * ply, 0.3 * (ply + 1)
    front = [at(-3, -2, top), at(3, -2, top), at(3, -2, bottom), at(-3, -2, bottom)]
    side = [at(3, -2, top), at(3, 2, top), at(3, 2, bottom), at(3, -2, bottom)]
    for face, shade in ((front, LIGHT), (side, "#c9d6e2")):
        axes.add_patch(plt.Polygon(face, facecolor=shade, edgecolor=INK, lw=0.8))
    axes.text(*at(-3.1, -2, (top + bottom) / 2), f"ply {ply + 1}: {angle}°", ha="right", va="center", fontsize=9)
axes.add_patch(plt.Polygon([at(-3, -2, 0), at(3, -2, 0), at(3, 2, 0), at(-3, 2, 0)], facecolor="white", edgecolor=INK))
for shift in (-1.2, -0.4, 0.4, 1.2):
    axes.plot(*zip(at(-2.9, shift, 0), at(2.9, shift, 0), strict=True), color=GREY, lw=0.5, ls=":")
origin = at(0, 0, 0)
arrow(axes, origin, at(1.8, 0, 0), BLUE)
axes.text(*at(0.7, 0, 0.35), "x, u, 0° fibres", color=BLUE, va="center")
arrow(axes, origin, at(0, 1.5, 0), BLUE)
axes.text(*at(0.1, 1.55, 0), "y, v", color=BLUE)
arrow(axes, at(4.9, 0, -0.4), at(4.9, 0, 1.0), BLUE)
axes.text(*at(5.0, 0, 0.9), "z, w\n(0 at mid-plane)", color=BLUE, va="center")
centre = at(0, 0, -1.35)
axes.add_patch(plt.Circle(centre, 0.55, facecolor="#eeeeee", edgecolor=INK))
axes.text(*centre, "m", ha="center", va="center")
arrow(axes, at(0, 0, -2.7), at(0, 0, -1.95), RED)
axes.text(*at(0.1, 0, -2.4), "velocity", color=RED)
arrow(axes, at(0, 0, -0.78), at(0, 0, -0.05), RED)
axes.text(*at(-0.15, 0, -0.45), "F on the plate", color=RED, va="center", ha="right")
axes.text(*at(-2.6, -1.6, 0.0), "struck face", fontsize=9)
axes.set_xlim(-7.2, 8.5)
axes.set_ylim(-2.7, 3.0)
save(figure, "coordinates")
