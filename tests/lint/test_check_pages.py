"""Shows that the checker of pages accepts good pages and finds each kind of breach."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_pages

INDEX = f"# Index\n\n{check_pages.BEGIN}\n{check_pages.END}\n"
GOOD = """\
# Page

See [below](#a-heading--with-signs), [the manual](manual/case.md#case-the-case) and `base/kinds.f90`, `kinds.f90`,
`src/base`, `src/*/kinds.f90`, `implam deck.nml`, `tests/<kind>/x.py`, `GROUP_deck.f90`, `src/base/new.f90`.

<!-- from src/base/kinds.f90 -->
```fortran
module kinds
...
integer, parameter :: wp = 8
```

## A heading, & with signs
"""
FILES = {
    "README.md": "# Readme\n",
    "doc/index.md": INDEX,
    "doc/page.md": GOOD,
    "doc/glossary.md": "# Glossary\n\n**term**: its meaning. [page](page.md#page)\n\n**other**: without a page.\n",
    "doc/manual/case.md": "# &case: the case\n\n| key | type |\n|---|---|\n| `name` | text |\n\n| `no_key` | of it |\n"
    "\n## What is warned of\nIt.\n\n## Limits\nIt.\n",
    "doc/manual/history.md": "# History\n\n| name | type |\n|---|---|\n| `time` | real |\n| `step` | integer |",
    "tests/examples/new.patch": "--- /dev/null\n+++ b/src/base/new.f90\n@@ -0,0 +1 @@\n+module new\n",
    "src/base/kinds.f90": "module kinds\n  implicit none\n  integer, parameter :: wp = 8\nend module kinds\n",
}


class PagesTest(unittest.TestCase):
    """Checks temporary folders."""

    def said(self, *options, **changed):
        """Return exit code and output of the checker, with some files changed after the index was written."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in FILES.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(check_pages.main([folder, "--write"]), 0)
            for name, text in changed.items():
                path = Path(folder, "doc", f"{name}.md").resolve()
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            self.index = Path(folder, "doc", "index.md").read_text(encoding="utf-8")
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                code = check_pages.main([folder, *options])
        return code, output.getvalue()

    def assert_breach(self, text, sentence):
        """Fail unless a page of this text is reported in this way, and in no other."""
        code, said = self.said(page=text)
        self.assertEqual(code, 1)
        self.assertIn(sentence, said)
        self.assertEqual(len(said.splitlines()), 1, said)

    def test_good_pages(self):
        """Good pages are accepted, and the index lists pages, keys and terms."""
        self.assertEqual(self.said(), (0, "6 pages keep the rules\n"))
        for entry in (
            "- [Page](page.md)",
            "- [&case](manual/case.md): `name`.",
            "- [history](manual/history.md): `time`, `step`.",
            "[term](page.md#page)",
            "[other](glossary.md)",
        ):
            self.assertIn(entry, self.index)
        self.assertNotIn("no_key", self.index)

    def test_links(self):
        """Links to no file and to no heading are found; those in code and to the web are ignored."""
        self.assert_breach("# Page\n[x](none.md)\n", "page.md:2: the link to none.md leads nowhere")
        self.assert_breach("# Page\n[x](manual/case.md#none)\n", "manual/case.md has no heading #none")
        self.assert_breach("# Page\n[x](#none)\n", "page.md has no heading #none")
        code, said = self.said(page="# Page\n`[x](none.md)` [web](https://example.org/none)\n")
        self.assertEqual(code, 0, said)

    def test_names(self):
        """Names of files that do not exist are found, with folder and without."""
        for name in (
            "base/none.f90",
            "none.f90",
            "src/base/none.f90",
            "src/none/*.f90",
            "input/none.nml",
            "doc/none.md",
        ):
            self.assert_breach(f"# Page\nIn `{name}`.\n", f"page.md:2: there is no file {name}")
        self.assert_breach("# Page\nRun `tests/none.py IMPLAM`.\n", "there is no file tests/none.py")

    def test_members(self):
        """A name quoted with its file must be in it, also if the quote extends over two lines."""
        for place in ("in `base/kinds.f90`", "of\n`src/base/kinds.f90`", "(`base/kinds.f90`)"):
            self.assert_breach(f"# Page\nIt is `lost`\n{place}.\n", "kinds.f90 has no lost")
            code, said = self.said(page=f"# Page\nIt is `wp` {place}.\n")
            self.assertEqual(code, 0, said)

    def test_quotes(self):
        """Quoted code must be in its file, in order."""
        quote = "# Page\n<!-- from src/base/kinds.f90 -->\n```fortran\n{}\n```\n"
        for lines in ("module none", "implicit none\nmodule kinds", "module kinds\ninteger, parameter :: wp = 8"):
            self.assert_breach(quote.format(lines), "src/base/kinds.f90 has no such line here")
        self.assert_breach(
            "# Page\n<!-- from src/none.f90 -->\n```\nx\n```\n", "there is no file src/none.f90 to quote"
        )
        self.assert_breach("# Page\n<!-- from src/base/kinds.f90 -->\ntext\n", "no block of code follows")
        code, said = self.said(page=quote.format("implicit none\n...\nend module kinds"))
        self.assertEqual(code, 0, said)

    def test_diary(self):
        """Words of a diary are found."""
        self.assert_breach("# Page\nThe deck as it was then.\n", '"as it was then" describes an earlier state')

    def test_index(self):
        """An index that lacks a page, a key or a term is found, and one without its comments."""
        self.assertIn("not up to date", self.said(other="# Another\n")[1])
        self.assertIn("not up to date", self.said(glossary="# Glossary\n\n**new**: a term.\n")[1])
        self.assertIn("lost the comments", self.said(index="# Index\n")[1])

    def test_questions(self):
        """Each page under doc/ has five questions, numbered from 1."""
        five = "".join(f"{number}. Why?\n" for number in range(1, 6))
        names = [name.removeprefix("doc/") for name in FILES if name.startswith("doc/")]
        asked = "# Reading test\n" + "".join(f"\n**[Title](../../doc/{name})**\n\n{five}" for name in names)
        self.assertNotIn("five questions", self.questions(asked))
        for name in names:
            lacking = asked.replace(f"\n**[Title](../../doc/{name})**\n\n{five}", "")
            self.assertIn(f"{name} has no five questions", self.questions(lacking))
        self.assertIn("has no five questions", self.questions(asked.replace("3. Why?\n", "", 1)))

    def questions(self, text):
        """Return what the checker says with this reading test."""
        return self.said(**{"../tests/pages/reading_test": text})[1]

    def test_groups(self):
        """The page of a group lists warnings and limits."""
        for lost in ("What is warned of", "Limits"):
            lacking = FILES["doc/manual/case.md"].replace(f"## {lost}\n", "")
            self.assertIn(f'has a section "{lost}"', self.said(**{"manual/case": lacking})[1])

    def test_longest(self):
        """A sentence of more than forty words is a breach; displayed equations are not part of it."""
        long = " ".join(["word"] * 41)
        self.assert_breach(f"# Page\n\n{long}.\n", "a sentence of 41 words")
        code, said = self.said(page=f"# Page\n\n{long[5:]}.\n\n$$\n{long} \\tag{{A1}}\n$$\n\nIt is $a = b + c$.\n")
        self.assertEqual(code, 0, said)

    def test_equations(self):
        """Gaps in the numbers of equations are found, equations without a number, and references to missing ones."""
        good = "# Theory\n\n$$\na \\tag{A1}\n$$\n\n$$\nb \\tag{A2}\n$$\n\nBy (A1) and (A2).\n"
        self.assertEqual(self.said(theory=good)[0], 1)  # the index lacks the page
        gap, none = good.replace("A2}", "A3}"), good.replace("(A2)", "(A4)")
        bare = good.replace(" \\tag{A2}", "").replace(" and (A2)", "")
        for text, sentence in ((gap, "without a gap"), (none, "no equation (A4)"), (bare, "without a number")):
            self.assertIn(sentence, self.said(theory=text)[1])
        self.assertNotIn("equation", self.said(theory=good)[1])

    def test_sentences(self):
        """Sentences of more than thirty words are counted; code, links and equations are at most one word."""
        long = " ".join(["word"] * 31)
        page = f"# Page\n\n{long}. {long[5:]}. `a b` [a b](page.md) et al. it.\n\n    {long}\n\n- {long}\n- a\n"
        page += f"\n|{long}|a|\n"
        said = self.said("--sentences", page=page)[1]
        self.assertIn("3 of ", said.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
