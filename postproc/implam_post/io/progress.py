"""How far many runs are: a bar with the time left on a terminal, a line a run anywhere else."""

import shutil
import sys
import time
from types import TracebackType
from typing import TextIO

_WIDTH = 24


class Progress:
    """Counts runs that have ended; used in a `with`, so that the bar's line ends."""

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        """Runs still to end are `total`; the progress goes to `stream`, the error output unless given."""
        self._total, self._ended, self._failed = total, 0, 0
        self._stream = stream or sys.stderr
        self._bar = self._stream.isatty()
        self._start = self._last = time.monotonic()

    def __enter__(self) -> "Progress":
        """Show the bar."""
        self.tick()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """End the bar's line."""
        if self._bar and self._total:
            self._stream.write("\n")

    def end_run(self, label: str, failure: str = "") -> None:
        """Count a run that has ended; one that failed is told at once."""
        self._ended, self._last = self._ended + 1, time.monotonic()
        self._failed += bool(failure)
        if self._bar:
            if failure:
                self._show(f"{label}: {failure}", "\n")
            self.tick()
        else:
            self._stream.write(f"[{self._ended}/{self._total}] {label}: {failure or 'done'}{self._left(self._last)}\n")
            self._stream.flush()

    def tick(self) -> None:
        """Draw the bar anew; nothing without a terminal."""
        if self._bar and self._total:
            full = _WIDTH * self._ended // self._total
            failed = f", {self._failed} failed" if self._failed else ""
            self._show(f"[{'#' * full}{'.' * (_WIDTH - full)}] {self._ended}/{self._total}{failed}"
                       f"{self._left(time.monotonic())}")

    def _left(self, now: float) -> str:
        """Return the time left, by the mean of the runs that have ended."""
        if not self._ended or self._ended == self._total:
            return ""
        seconds = (self._last - self._start) / self._ended * (self._total - self._ended) - (now - self._last)
        return f", {duration(max(seconds, 0.0))} left"

    def _show(self, text: str, end: str = "") -> None:
        """Write over the bar's line; a bar is no longer than the terminal is wide."""
        width = shutil.get_terminal_size().columns - 1
        self._stream.write(f"\r{(text if end else text[:width]).ljust(width)}{end}")
        self._stream.flush()


def duration(seconds: float) -> str:
    """Return a time as a person would say it."""
    if seconds < 100:
        return f"{seconds:.0f} s" if seconds >= 10 else f"{seconds:.1f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60} min"
