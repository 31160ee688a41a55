"""A movie of a run (`implam-movie NAME.h5`): delamination of all interfaces in plan, with force or stress below."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from PIL import Image

from implam_post.io.compression import STRESS
from implam_post.io.errors import EXIT_DONE, CommandParser, FileError, ImplamError, positive, reason, run
from implam_post.io.fields import Fields, read_fields
from implam_post.io.files import replaced
from implam_post.io.history import History
from implam_post.io.run import open_run
from implam_post.plot.compression import is_compressed
from implam_post.plot.plan import add_depths, depth_colours, draw_depths
from implam_post.plot.plan_frame import frame, reach_of, state_of
from implam_post.plot.style import PictureStyle, add_options, style_of

# Column drawn against time: of an impact, of a compression.
_LOADS = (("force", "contact force", "force"), (STRESS, "far-field stress", "stress"))

# Up to this many interfaces are named in a legend, more beside a bar of colours.
_FEW = 6
# Smallest and largest frame rate: files store durations in hundredths or thousandths of a second.
_RATES = (0.01, 1000.0)
# Endings of files that have several pictures.
_ENDINGS = (".gif", ".webp", ".png")


def frames(fields: Fields, history: History | None, style: PictureStyle) -> list[Image.Image]:
    """Return a picture for each time written, all on the same scale."""
    return [_picture(fields, history, style, place) for place in range(len(fields.snapshots))]


def _picture(fields: Fields, history: History | None, style: PictureStyle, moment: int) -> Image.Image:
    """Draw the delaminations at a time, one colour per interface, the interface nearest to the struck face on top."""
    time = fields.snapshots[moment].time
    figure = Figure(figsize=(6, 6 if history is None else 8), layout="constrained", dpi=style.dots_per_inch)
    canvas = FigureCanvasAgg(figure)
    plan, *below = np.ravel(figure.subplots(1 if history is None else 2, squeeze=False,
                                            height_ratios=[1] if history is None else [3, 1]))
    interfaces = fields.snapshots[-1].mesh.interfaces
    draw_depths(plan, [fields.delaminated(moment, below_ply) for below_ply in interfaces])
    if len(interfaces) > _FEW:
        add_depths(plan, interfaces, "delaminated interface nearest to the struck face, below ply", "right")
    else:
        plan.legend(handles=[Patch(color=colour, label=f"below ply {below_ply}") for below_ply, colour in
                             zip(interfaces, depth_colours(len(interfaces)), strict=True)],
                    loc="upper right", fontsize="small")
    plan.set_title(state_of(fields, time, style))
    last = len(fields.snapshots) - 1
    frame(plan, fields, reach_of(np.concatenate([fields.delaminated(last, ply) for ply in interfaces]), fields), style)
    if history is not None:
        clock = style.clock(history.time, [history.by_load_steps])
        column, label, dimension = _LOADS[is_compressed(history)]
        load = style.axis(label, dimension, history[column])
        below[0].plot(clock.factor * history.time, load.factor * history[column], linewidth=1)
        below[0].plot(clock.factor * time, load.factor * history.at(column, min(time, history.time[-1])), "o")
        below[0].set(xlabel=clock.label, ylabel=load.label)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _command(options: argparse.Namespace) -> int:
    """Draw the movie and print its path."""
    style = style_of(options, [options.fields])
    if not _RATES[0] <= options.rate <= _RATES[1]:
        raise ImplamError(f"--rate must be from {_RATES[0]:g} to {_RATES[1]:g}.")
    path = options.save or options.fields.with_suffix(".gif")
    if path.suffix.lower() not in _ENDINGS:
        raise ImplamError(f"--save: {path} does not end with {', '.join(_ENDINGS[:-1])} or {_ENDINGS[-1]}.")
    fields = read_fields(options.fields)
    if not fields.snapshots[-1].mesh.interfaces:
        raise FileError(f"{options.fields} has no interface that may delaminate.")
    with matplotlib.rc_context({"font.size": style.letters}):
        pictures = frames(fields, open_run(options.fields).columns, style)
    try:
        with replaced(path) as draft:
            pictures[0].save(draft, save_all=True, append_images=pictures[1:], duration=1000 / options.rate, loop=0)
    except ValueError as error:
        raise FileError(f"{path} cannot be written ({reason(error)}).") from None
    print(path)
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-movie", description="Draw the delamination of the interfaces of NAME.h5, a picture "
                           "for each time written (`fields_every` of &output), with the force of the history or the "
                           "stress of a compression below.")
    parser.add_argument("fields", type=Path, metavar="NAME.h5")
    parser.add_argument("--save", type=Path, metavar="FILE", help="file, .gif, .webp or .png (default: NAME.gif)")
    parser.add_argument("--rate", type=positive, default=5.0, help="pictures per second (default: 5)")
    add_options(parser)
    parser.set_defaults(dpi=80, format="png")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
