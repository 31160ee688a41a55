"""Numbers with nouns in the singular or plural, and lists of plies."""

from collections.abc import Iterable


def counted(number: int, noun: str, plural: str | None = None) -> str:
    """Return a number with its noun, in the plural unless the number is 1; the default plural ends with s."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def listed(plies: Iterable[int]) -> str:
    """Return numbers of plies as text, consecutive ones as ranges."""
    runs: list[list[int]] = []
    for ply in sorted(plies):
        if runs and ply == runs[-1][-1] + 1:
            runs[-1].append(ply)
        else:
            runs.append([ply])
    words = [str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
    return ("ply " if sum(map(len, runs)) == 1 else "plies ") + ", ".join(words)
