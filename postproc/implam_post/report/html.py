"""Pieces of a page that needs no other file: tables, pictures, the page around them."""

import base64
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

from matplotlib.figure import Figure

from implam_post.report.pictures import as_image

_STYLE = """
body { font-family: sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; margin: .6em 0; }
td, th { border-bottom: 1px solid #ccc; padding: .2em .8em .2em 0; text-align: left; vertical-align: top; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
img { max-width: 100%; } pre { background: #f4f4f4; padding: .8em; overflow-x: auto; }
.done { color: #176117; } .stopped, .failed, .warning { color: #a01010; }
"""


def number(value: object) -> str:
    """Return a number rounded to four digits; a dash for what is not there."""
    if value is None:
        return "-"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table; numbers stand on the right."""
    def cell(tag: str, value: object) -> str:
        kind = ' class="number"' if isinstance(value, (int, float)) else ""
        return f"<{tag}{kind}>{escape(number(value))}</{tag}>"

    lines = ["<table>"]
    if head:
        lines.append("<tr>" + "".join(cell("th", name) for name in head) + "</tr>")
    lines += ["<tr>" + "".join(cell("td", value) for value in row) + "</tr>" for row in rows]
    return "\n".join([*lines, "</table>"])


def picture(figure: Figure, text: str) -> str:
    """Return a figure as an image within the page."""
    return _image(as_image(figure), text)


def picture_of(path: Path, text: str) -> str:
    """Return a PNG file as an image within the page."""
    return _image(base64.b64encode(path.read_bytes()).decode("ascii"), text)


def _image(data: str, text: str) -> str:
    """Return an image of base64."""
    return f'<p><img alt="{escape(text)}" src="data:image/png;base64,{data}"></p>'


def page(title: str, parts: Iterable[str]) -> str:
    """Return the whole page."""
    body = "\n".join(parts)
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
            f"<style>{_STYLE}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n")
