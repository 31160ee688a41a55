"""Progress of many runs: a bar with the remaining time on a terminal, otherwise a line for each run."""

import sys
import time
from types import TracebackType
from typing import TextIO

from tqdm import tqdm


class Progress:
    """Counter of ended runs; to be used in a `with` statement, which ends the line of the bar."""

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        """Count up to `total` runs; print to `stream`, by default the error output."""
        self._stream = stream or sys.stderr
        self._total, self._ended, self._failed, self._start = total, 0, 0, time.monotonic()
        self._bar = tqdm(total=total, file=self._stream, unit="run", dynamic_ncols=True, miniters=1) if (
            self._stream.isatty() and total) else None

    def __enter__(self) -> "Progress":
        """Begin."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """End the line of the bar."""
        if self._bar is not None:
            self._bar.close()

    def end_run(self, label: str, failure: str = "") -> None:
        """Count a run that has ended; a failed run is reported immediately."""
        self._ended, self._failed = self._ended + 1, self._failed + bool(failure)
        if self._bar is None:
            seconds = (time.monotonic() - self._start) / self._ended * (self._total - self._ended)
            left = f", {tqdm.format_interval(seconds)} left" if self._ended < self._total else ""
            print(f"[{self._ended}/{self._total}] {label}: {failure or 'done'}{left}", file=self._stream, flush=True)
            return
        if failure:
            self._bar.write(f"{label}: {failure}", file=self._stream)
            self._bar.set_postfix_str(f"{self._failed} failed", refresh=False)
        self._bar.update()

    def tick(self) -> None:
        """Update the time of the bar; without a terminal do nothing."""
        if self._bar is not None and time.time() - self._bar.last_print_t > 1:
            self._bar.refresh()
            self._bar.last_print_t = time.time()
