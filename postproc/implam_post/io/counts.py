"""Numbers with the nouns of what they count."""


def counted(number: int, noun: str, plural: str | None = None) -> str:
    """Return a number and its noun, in the plural unless the number is 1; without `plural` that ends with s."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"
