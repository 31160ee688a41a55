"""Layers of a plate at an interface, and the jumps between them. Usage: layers.py [FOLDER]"""

from drawing import BLUE, GREY, INK, LIGHT, RED, arrow, canvas, plt, save

figure, axes = canvas(8, 3.4)


def plate(x0, x1, z0, z1, shade=LIGHT):
    """A layer from x0 to x1 and from z0 down to z1."""
    axes.add_patch(plt.Rectangle((x0, -z1), x1 - x0, z1 - z0, facecolor=shade, edgecolor=INK, lw=0.9))


plate(-5, -2, 0, 1.6)
plate(-2, 2.5, 0, 0.9, "#e7eef4")
plate(-2, 2.5, 0.9, 1.6, "#c9d6e2")
axes.plot([-5.3, 6.5], [-0.8, -0.8], color=GREY, lw=0.8, ls="-.")
axes.text(6.55, -0.8, "mid-plane, z = 0", va="center", fontsize=9, color=GREY)
axes.text(-3.5, -0.35, "one layer", ha="center", fontsize=9)
axes.text(0.2, -0.35, "layer 1 (plies 1 to n)", ha="center", fontsize=9)
axes.text(0.2, -1.35, "layer 2 (plies n + 1 to ...)", ha="center", fontsize=9)
axes.plot([-2, 2.5], [-0.9, -0.9], color=RED, lw=2)
axes.text(-1.9, 0.15, "zone of the interface", color=RED, fontsize=9)
arrow(axes, (-2, 0.1), (2.5, 0.1), RED, 0.8)
axes.annotate("interface at $z_i$", xy=(-1.0, -0.9), xytext=(-1.6, -2.2), color=RED, fontsize=9,
              arrowprops={"arrowstyle": "-", "color": RED})
axes.annotate("border: shared nodes", xy=(-2, -1.6), xytext=(-5, -2.2), fontsize=9,
              arrowprops={"arrowstyle": "-", "color": INK})
# Beside it, opened.
plate(3.6, 6.2, 0, 0.9, "#e7eef4")
plate(3.9, 6.5, 1.35, 2.05, "#c9d6e2")
arrow(axes, (5.0, -0.9), (5.0, -1.35), BLUE)
axes.text(5.08, -1.15, "gap g > 0", color=BLUE, fontsize=9, va="center")
arrow(axes, (3.6, -1.12), (3.9, -1.12), BLUE)
axes.text(3.75, -1.3, "shear $s_1$", color=BLUE, fontsize=9, ha="right", va="center")
axes.text(4.9, 0.15, "after delamination", ha="center", fontsize=9)
axes.set_xlim(-5.4, 9)
axes.set_ylim(-2.5, 0.6)
save(figure, "layers")
