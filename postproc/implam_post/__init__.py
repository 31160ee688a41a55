"""Python interface of Implam and its commands: open runs, run decks with changed keys, compare runs.

    import implam_post as implam

    run = implam.run_deck("impact.nml", {"impactor%velocity": 2.5}, output="fast").wait()
    run.history.plot(x="time", y="force")

It shares no code with the solver, so that its reference solutions are independent. Names are imported when they are
first used, so that commands start quickly.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from implam_post.io.deck import Deck, read_deck
    from implam_post.io.errors import DeckError, FileError, ImplamError
    from implam_post.io.run import Field, Run, open_run
    from implam_post.io.run_figures import Measured, compare
    from implam_post.io.start import RunError, StartedRun, run_deck

__all__ = ["Deck", "DeckError", "Field", "FileError", "ImplamError", "Measured", "Run", "RunError", "StartedRun",
           "compare", "open_run", "read_deck", "run_deck"]
_MODULES = {"deck": ("Deck", "read_deck"), "errors": ("DeckError", "FileError", "ImplamError"),
            "run": ("Field", "Run", "open_run"), "run_figures": ("Measured", "compare"),
            "start": ("RunError", "StartedRun", "run_deck")}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> object:
    """Return a name of the interface from its module."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.io.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """Return the names of the interface."""
    return __all__
