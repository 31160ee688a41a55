"""Self-contained HTML pages from the templates of this package."""

import base64
import io
from pathlib import Path

from jinja2 import Environment, PackageLoader
from matplotlib.figure import Figure

from implam_post.plot.style import lay_out


def rounded(value: object) -> str:
    """Return a number rounded to four digits; a dash for a missing one."""
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


_TEMPLATES = Environment(loader=PackageLoader("implam_post.report"), autoescape=True, trim_blocks=True,
                         lstrip_blocks=True)
_TEMPLATES.filters["rounded"] = rounded


def render(template: str, **content: object) -> str:
    """Return the page of a template with its content."""
    return _TEMPLATES.get_template(template).render(content)


def image(figure: Figure) -> str:
    """Return a figure as a PNG in base64."""
    stream = io.BytesIO()
    lay_out(figure)
    figure.savefig(stream, format="png", dpi=100)
    return base64.b64encode(stream.getvalue()).decode("ascii")


def image_of(path: Path) -> str:
    """Return a PNG file in base64."""
    return base64.b64encode(path.read_bytes()).decode("ascii")
