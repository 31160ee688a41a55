"""The rig of a drop-weight test: frame with a window, clamps, impactor. Usage: rig.py [FOLDER]"""

from drawing import BLUE, GREY, INK, LIGHT, RED, arrow, plt, save

figure, (above, beside) = plt.subplots(1, 2, figsize=(8.5, 3.6), width_ratios=(1.3, 1))
for axes in (above, beside):
    axes.set_aspect("equal")
    axes.axis("off")
# From above, in mm: plate 150 x 100, window 125 x 75, four clamps.
above.add_patch(plt.Rectangle((-90, -65), 180, 130, facecolor="#eeeeee", edgecolor=GREY))
above.add_patch(plt.Rectangle((-75, -50), 150, 100, facecolor=LIGHT, edgecolor=INK))
above.add_patch(plt.Rectangle((-62.5, -37.5), 125, 75, facecolor="white", edgecolor=INK, ls="--", alpha=0.7))
for x in (-50, 50):
    for y in (-43.75, 43.75):
        above.add_patch(plt.Circle((x, y), 7, facecolor=RED, edgecolor=INK, alpha=0.6))
above.add_patch(plt.Circle((0, 0), 8, facecolor="none", edgecolor=BLUE))
above.text(11, 3, "impactor, radius 8 mm", color=BLUE, fontsize=9)
above.text(0, -26, "window 125 x 75 (&support window)", ha="center", fontsize=9)
above.text(0, 56, "plate 150 x 100 (&plate length), on a frame", ha="center", va="center", fontsize=9)
above.text(61, 43.75, "clamp", color=RED, fontsize=9, va="center")
arrow(above, (-85, -60), (-60, -60), BLUE)
above.text(-58, -60, "x", color=BLUE, va="center")
arrow(above, (-85, -60), (-85, -38), BLUE)
above.text(-85, -36, "y", color=BLUE, ha="center")
above.set_xlim(-92, 92)
above.set_ylim(-67, 67)
# From the side.
beside.add_patch(plt.Rectangle((-75, -8), 150, 8, facecolor=LIGHT, edgecolor=INK))
for x in (-90, 62.5):
    beside.add_patch(plt.Rectangle((x, -26), 27.5, 18, facecolor="#cccccc", edgecolor=INK))
beside.text(0, -32, "frame: carries, does not pull (unilateral)", ha="center", va="top", fontsize=9)
for x in (-62, 62):
    beside.add_patch(plt.Polygon([(x - 6, 0), (x + 6, 0), (x + 4, 12), (x - 4, 12)], facecolor=RED, alpha=0.6))
beside.text(66, 12, "clamp: spring on w", color=RED, fontsize=9, ha="center", va="bottom")
beside.add_patch(plt.Circle((0, 9.5), 8, facecolor="#eeeeee", edgecolor=INK))
beside.add_patch(plt.Rectangle((-8, 9.5), 16, 30, facecolor="#eeeeee", edgecolor=INK))
arrow(beside, (18, 45), (18, 22), RED)
beside.text(21, 35, "mass, energy", color=RED, fontsize=9)
arrow(beside, (-40, 20), (-40, -6), BLUE)
beside.text(-44, 22, "z, w", color=BLUE)
beside.set_xlim(-95, 110)
beside.set_ylim(-50, 50)
save(figure, "rig")
