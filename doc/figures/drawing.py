"""What the drawings of the pages share: fonts, colours, arrows, and how they are saved."""

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("svg")
import matplotlib.pyplot as plt

INK, BLUE, RED, GREEN, GREY, LIGHT = "#222222", "#2266aa", "#bb3333", "#2a7a3a", "#888888", "#dde6ee"
plt.rcParams.update({"svg.hashsalt": "implam", "svg.fonttype": "none", "font.family": "sans-serif", "font.size": 10})


def canvas(width, height):
    """A figure without axes, its unit as long in x as in y."""
    figure, axes = plt.subplots(figsize=(width, height))
    axes.set_aspect("equal")
    axes.axis("off")
    return figure, axes


def arrow(axes, start, end, colour=INK, width=1.4):
    """An arrow between two points."""
    axes.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": width})


def box(axes, centre, size, text, colour=LIGHT, edge=INK):
    """A box with text in it."""
    x, y = centre[0] - size[0] / 2, centre[1] - size[1] / 2
    axes.add_patch(plt.Rectangle((x, y), *size, facecolor=colour, edgecolor=edge, lw=1.0))
    axes.text(*centre, text, ha="center", va="center", fontsize=9)


def save(figure, name):
    """Save it in the folder given, or beside the scripts."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    figure.savefig(folder / f"{name}.svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
