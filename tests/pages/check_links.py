"""Builds the site and checks its links. Usage: check_links.py DOC FOLDER [--inner]        (target linkcheck)

Links within the site: the file exists and has the anchor; a breach ends with code 1. External links: Sphinx's
linkcheck. A server that reports a missing page is a breach; without a network, that is if no server can be reached, the
links are listed as skipped. --inner excludes external links. Ends with code 77 where Sphinx is not installed."""

import json
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from build_site import main as build_site

# Results of linkcheck for links that a server serves, at their address or another.
SERVED = ("working", "redirected")


class Page(HTMLParser):
    """Anchors of a page, and the targets of its links and pictures."""

    def __init__(self, path):
        """Read the page."""
        super().__init__()
        self.anchors, self.targets = {""}, []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, _tag, attrs):
        """Store the definitions and links of a tag."""
        for name, value in attrs:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.targets.append(value)


def inner_breaches(site):
    """Number of links within the site, and the invalid ones."""
    pages = {path: Page(path) for path in sorted(site.rglob("*.html"))}
    checked, wrong = 0, []
    for path, page in pages.items():
        for target in page.targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            checked += 1
            linked = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            known = pages[linked].anchors if linked in pages else {unquote(parts.fragment)}
            if not linked.is_file() or unquote(parts.fragment) not in known:
                wrong.append(f"{path.relative_to(site)}: {target} leads nowhere")
    return checked, wrong


def classified(found):
    """Served, invalid and unreachable links of linkcheck's records; with a network an unreachable one is invalid."""
    outer = {record["uri"]: record for record in found if record["status"] not in ("unchecked", "local", "ignored")}
    served = [uri for uri, record in outer.items() if record["status"] in SERVED]
    reported = [uri for uri, record in outer.items() if record["status"] not in SERVED and record["code"]]
    silent = sorted(outer.keys() - {*served, *reported})
    return (served, reported + silent, []) if served or reported else (served, [], silent)


def outer_links(doc, folder):
    """Served, invalid and unreachable external links of the pages."""
    subprocess.run([sys.executable, "-B", "-m", "sphinx", "-Q", "-E", "-b", "linkcheck", doc, folder], check=False)
    lines = Path(folder, "output.json").read_text(encoding="utf-8").splitlines()
    return classified([json.loads(line) for line in lines])


def main(doc, folder, *options):
    """Check both kinds of links; return the exit code."""
    site = Path(folder, "site").resolve()
    code = build_site(doc, str(site))
    if code:
        return code
    checked, wrong = inner_breaches(site)
    served, invalid, skipped = ([], [], []) if "--inner" in options else outer_links(doc, str(Path(folder, "outer")))
    for line in [*wrong, *(f"invalid: {uri}" for uri in invalid), *(f"skipped, no network: {uri}" for uri in skipped)]:
        print(line)
    print(f"{checked} links within the site, {len(wrong)} wrong")
    if "--inner" not in options:
        print(f"{len(served)} external links work, {len(invalid)} are invalid, {len(skipped)} were skipped")
    return 1 if wrong or invalid else 0


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit("Usage: check_links.py DOC FOLDER [--inner]")
    sys.exit(main(*sys.argv[1:]))
