"""Numbers with nouns in the singular or plural."""


def counted(number: int, noun: str, plural: str | None = None) -> str:
    """Return a number with its noun, in the plural unless the number is 1; the default plural ends with s."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"
