"""Tests of check_links.py on pages and records of a few lines."""

import tempfile
import unittest
from pathlib import Path

from check_links import classified, inner_breaches


def record(uri, status, code=0):
    """A record of linkcheck."""
    return {"uri": uri, "status": status, "code": code}


class InnerLinks(unittest.TestCase):
    """Links within a site of two pages."""

    def breaches(self, link):
        """Breaches of a page with one link."""
        with tempfile.TemporaryDirectory() as folder:
            site = Path(folder).resolve()
            (site / "other.html").write_text('<h2 id="there">There</h2>', encoding="utf-8")
            (site / "index.html").write_text(f'<p id="here"><a href="{link}">link</a></p>', encoding="utf-8")
            checked, wrong = inner_breaches(site)
        self.assertEqual(checked, 0 if link.startswith("https") else 1)
        return len(wrong)

    def test_links_that_lead_somewhere(self):
        """Pages, anchors of this page and of another."""
        for link in ("other.html", "other.html#there", "#here", "#", "https://example.org/none"):
            self.assertEqual(self.breaches(link), 0, link)

    def test_links_that_lead_nowhere(self):
        """A page and anchors that do not exist."""
        for link in ("none.html", "other.html#here", "#there"):
            self.assertEqual(self.breaches(link), 1, link)


class OuterLinks(unittest.TestCase):
    """Records of linkcheck with and without a network."""

    def test_without_a_network_links_are_skipped(self):
        """No server has responded."""
        found = [record("https://a.org", "invalid"), record("#inner", "unchecked"), record("b.md", "local")]
        self.assertEqual(classified(found), ([], [], ["https://a.org"]))

    def test_with_a_network_missing_pages_and_servers_are_invalid(self):
        """One server serves its page, one reports a missing page, one does not exist."""
        found = [record("https://a.org", "working", 200), record("https://b.org", "invalid", 404),
                 record("https://c.org", "timeout")]  # fmt: skip
        self.assertEqual(classified(found), (["https://a.org"], ["https://b.org", "https://c.org"], []))


if __name__ == "__main__":
    unittest.main()
