"""Builds the pages as a site: sphinx-build -W doc build/site. The pages are Markdown that also reads well unbuilt."""

import re
from pathlib import Path

from docutils.nodes import math_block

ROOT = Path(__file__).resolve().parents[1]


def declared_version():
    """The version that CMakeLists.txt declares."""
    return re.search(r"project\(implam VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


project = "Implam"
author = "The Implam developers"
copyright = author
release = version = declared_version()

extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["news/**", "examples/**"]
nitpicky = True

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 4
mathjax3_config = {"tex": {"tags": "none"}}

html_theme = "furo"
html_title = f"Implam {release}"
html_show_sourcelink = False

# Checked where there is a network: sphinx-build -b linkcheck doc build/links.
linkcheck_timeout = 20
linkcheck_retries = 2


def bare_displays(_app, tree):
    """Hand displayed equations to MathJax as they stand: Sphinx's own wrapping refuses the numbers given by tags."""
    for node in tree.findall(math_block):
        node["no-wrap"] = node["nowrap"] = True
        node.replace_self(math_block("", rf"\[{node.astext().strip()}\]", **node.attributes))


OUTSIDE = re.compile(
    r"(?<!!)\[([^\]]*)\]"
    r"\(((?:\.\./)+(?!manual/|theory/|studies/|tutorial/)[\w./-]*|news/README)\.md(?:#[\w-]*)?\)"
)


def drop_links_outside(app, name, source):
    """Leave the words of links to Markdown that is not part of the site; CHANGELOG.md stands in for its page."""
    folder = Path(app.srcdir, name).parent

    def words(match):
        path = (folder / f"{match.group(2)}.md").resolve()
        outside = not path.is_relative_to(app.srcdir) or "news" in path.parts
        return match.group(1) if outside else match.group(0)

    if name == "changelog":
        source[0] = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").replace("](doc/", "](")
    source[0] = OUTSIDE.sub(words, source[0])


def setup(app):
    """Register what is above."""
    app.connect("source-read", drop_links_outside)
    app.connect("doctree-read", bare_displays)
