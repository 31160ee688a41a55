"""References of the problems of a study: a run, a history, or a semi-analytic solution."""

import hashlib
import json
import math
import re
from pathlib import Path

from implam_post.io.deck import Deck
from implam_post.io.deck_text import KeyPath, set_keys
from implam_post.io.errors import DeckError
from implam_post.io.files import write_table
from implam_post.io.history import History, read_history
from implam_post.io.namelist import read_namelist
from implam_post.io.program import history_in
from implam_post.reference.semi_analytic import semi_analytic
from implam_post.study.plan import Trial
from implam_post.sweep.plan import Case
from implam_post.sweep.runs import Sweep

# Groups on which a semi-analytic solution depends; of other groups it depends on the patch and the end time.
_PHYSICS = ("plate", "material", "laminate", "impactor", "indentation", "pressure", "static")
_COLUMNS = ("time", "force", "impactor_velocity", "deflection")


class References:
    """Cache of references; semi-analytic solutions are stored on disk, too."""

    def __init__(self, sweep: Sweep) -> None:
        """Solutions are stored in the folder of the runs."""
        self._sweep, self._folder = sweep, sweep.plan.output / "references"
        self._known: dict[str, History] = {}

    def of(self, trial: Trial) -> History | None:
        """Return the reference of a trial whose first run has ended; None if the reference run has not ended."""
        reference = trial.problem.reference
        if isinstance(reference, Case):
            return None if self._sweep.failure(reference) else self._read(_history(self._sweep.folder(reference)))
        if isinstance(reference, Path):
            return self._read(reference)
        return self._solution(trial.runs[0])

    def _read(self, path: Path) -> History:
        """Return a history, which is read once."""
        if str(path) not in self._known:
            self._known[str(path)] = read_history(path)
        return self._known[str(path)]

    def _solution(self, run: Case) -> History:
        """Return the semi-analytic solution with the actual patch and end time of a run."""
        log = next(iter(sorted(self._sweep.folder(run).glob("*.log"))))
        text = log.read_text(encoding="utf-8", errors="replace")
        patch, end = _in_effect(text, "mesh", "patch"), _rounded_up(_in_effect(text, "time", "end"))
        groups = read_namelist(run.deck, run.deck_name)
        content = json.dumps([[[{key: value for key, value in group.items() if key != "integrator"}
                             for group in groups.get(name, [])] for name in _PHYSICS], patch, end])
        path = self._folder / f"{hashlib.sha256(content.encode()).hexdigest()[:12]}.csv"
        if not path.exists():
            deck = set_keys(run.deck, {KeyPath("mesh", None, "patch"): repr(patch),
                                       KeyPath("time", None, "end"): repr(end)}, run.deck_name)
            _write(semi_analytic(Deck(deck, Path(run.deck_name))), path)
        return self._read(path)


def _history(folder: Path) -> Path:
    """Return the path of the history in the folder of a run."""
    return history_in(folder) or folder / "history.csv"


def _in_effect(log: str, group: str, key: str) -> float:
    """Return the value of a key in a run, from its log."""
    found = re.search(rf"^&{group} {key} = (\S+) \[", log, re.MULTILINE)
    if found is None:
        raise DeckError(f"the log has no {key} of &{group}.")
    return float(found[1].lower().replace("d", "e"))


def _rounded_up(end: float) -> float:
    """Return a time rounded up to two digits, so that runs with nearly equal end times share a solution."""
    unit = 10.0**(math.floor(math.log10(end)) - 1)
    return float(f"{math.ceil(end / unit * (1 - 1e-9)) * unit:.6g}")


def _write(history: History, path: Path) -> None:
    """Write a solution as a history."""
    write_table(path, history.table()[[*_COLUMNS]], "%.9e")
