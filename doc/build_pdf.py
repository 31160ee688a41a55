#!/usr/bin/env python3
"""Writes the pages as one PDF, without TeX: Sphinx's single page, equations by ziamath, layout by WeasyPrint.

Usage: build_pdf.py DOC PDF          requires doc/requirements.txt and doc/requirements-pdf.txt
"""

import base64
import html
import logging
import re
import subprocess
import sys
import tempfile
from pathlib import Path

MATH = re.compile(r'<(span|div) class="math[^"]*">\s*\\([(\[])(.*?)\\[)\]]\s*</\1>', re.DOTALL)
TAG = re.compile(r"\\tag\{([^}]*)\}")
ANCHOR = re.compile(r'\b(id="|href="#)([^"]+)"')
STYLE = """
@page { size: A4; margin: 20mm 18mm; @bottom-center { content: counter(page); font: 9pt serif; } }
body { font: 9.5pt/1.35 "DejaVu Serif", serif; }
h1 { break-before: page; font-size: 17pt; bookmark-level: 1; }
h2 { font-size: 12.5pt; bookmark-level: 2; } h3 { font-size: 11pt; bookmark-level: 3; }
pre, code { font: 7.5pt "DejaVu Sans Mono", monospace; }
pre { white-space: pre-wrap; background: #f4f4f4; padding: 4pt; }
table { border-collapse: collapse; font-size: 7.5pt; width: 100%; }
td, th { border-bottom: .3pt solid #999; padding: 1.5pt 3pt; vertical-align: top; overflow-wrap: anywhere; }
td code, th code { font-size: 6.5pt; }
img { max-width: 100%; } a { color: #14406b; text-decoration: none; }
.headerlink, .related, .sphinxsidebar { display: none; }
.equation { text-align: center; margin: 6pt 0; } .number { float: right; }
"""


def drawn(latex, size):
    """An image of a formula, on the base line of the text."""
    import ziamath

    formula = ziamath.Latex(latex, size=size)
    svg = base64.b64encode(formula.svg().encode()).decode()
    return f'<img style="vertical-align:{formula.getyofst():.2f}px" src="data:image/svg+xml;base64,{svg}">'


def with_equations(text):
    """The page with images in the place of formulas; those that cannot be drawn stay as they are written."""
    failed = []

    def image(match):
        latex = html.unescape(match[3]).strip()
        tag = TAG.search(latex)
        number = f'<span class="number">({tag[1]})</span>' if tag else ""
        try:
            picture = drawn(TAG.sub("", latex).strip(), 12.5 if match[1] == "span" else 14)
        except Exception as error:  # of several kinds, by the parser of formulas
            failed.append(f"{latex}: {error}")
            picture = f"<code>{match[3]}</code>"
        return picture if match[1] == "span" else f'<div class="equation">{number}{picture}</div>'

    return MATH.sub(image, text), failed


def with_anchors(text):
    """The page with the anchors of each document named after it, as links from other documents name them."""
    document = "document-index"

    def named(match):
        nonlocal document
        if match[2].startswith("document-"):
            document = match[2] if match[1] == 'id="' else document
            return match[0]
        return f'{match[1]}{document}#{match[2]}"'

    return ANCHOR.sub(named, text.replace("<body", '<body id="document-index"', 1))


class Unresolved(logging.Handler):
    """Keeps the errors of WeasyPrint, such as links without an anchor; its warnings are about rules for screens."""

    def __init__(self):
        """Take the place of its own handlers."""
        super().__init__(logging.ERROR)
        self.messages = []
        logger = logging.getLogger("weasyprint")
        logger.handlers, logger.propagate = [self], False

    def emit(self, record):
        """Keep a message."""
        self.messages.append(record.getMessage())


def main(doc, pdf):
    """Build; return 1 if a formula could not be drawn, or a link leads nowhere."""
    import weasyprint

    unresolved = Unresolved()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-B", "-m", "sphinx", "-q", "-E", "-b", "singlehtml", "-D", "html_theme=basic",
                        "-D", "html_permalinks=0", doc, folder], check=True)  # fmt: skip
        page = Path(folder, "index.html")
        text, failed = with_equations(page.read_text(encoding="utf-8"))
        page.write_text(with_anchors(re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)), encoding="utf-8")
        weasyprint.HTML(filename=str(page)).write_pdf(pdf, stylesheets=[weasyprint.CSS(string=STYLE)])
    wrong = [f"not drawn: {formula}" for formula in failed] + unresolved.messages
    print("\n".join(wrong) or f"{pdf}: all equations are drawn, all links within it lead to a page")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
