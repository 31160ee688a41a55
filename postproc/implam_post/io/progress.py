"""How far many runs are: a bar with the time left on a terminal, a line for each run anywhere else."""

import sys
import time
from types import TracebackType
from typing import TextIO

from tqdm import tqdm


class Progress:
    """Counts runs that have ended; used in a `with`, so that the bar's line ends."""

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        """Runs still to end are `total`; the progress goes to `stream`, the error output unless given."""
        self._stream = stream or sys.stderr
        self._total, self._ended, self._failed, self._start = total, 0, 0, time.monotonic()
        self._bar = tqdm(total=total, file=self._stream, unit="run", dynamic_ncols=True, miniters=1) if (
            self._stream.isatty() and total) else None

    def __enter__(self) -> "Progress":
        """Begin."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        """End the bar's line."""
        if self._bar is not None:
            self._bar.close()

    def end_run(self, label: str, failure: str = "") -> None:
        """Count a run that has ended; one that failed is reported at once."""
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
        """Let the bar's clock go on; nothing without a terminal."""
        if self._bar is not None and time.time() - self._bar.last_print_t > 1:
            self._bar.refresh()
            self._bar.last_print_t = time.time()
