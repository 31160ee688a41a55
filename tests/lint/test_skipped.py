"""Tests that the skips of a run of ctest are listed with their reasons."""

import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import skipped

RUN = """<testsuite>
<testcase name="whole" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>
<system-out>started
skipped: sbatch is not installed
</system-out></testcase>
<testcase name="silent" status="notrun"><system-out/></testcase>
<testcase name="parts" status="run"><system-out>test_a (tests.test_a.ATest.test_a)
What it is for. ... skipped "pyNastran is not installed"
test_b (tests.test_b.BTest.test_b) ... skipped "pyNastran is not installed"
OK (skipped=2)
</system-out></testcase>
<testcase name="complete" status="run"><system-out>steps are skipped here and there
test_c (tests.test_c.CTest.test_c) ... ok
</system-out></testcase>
</testsuite>"""


class SkippedTest(unittest.TestCase):
    """The printed list for a run."""

    def printed(self, run):
        """Return the lines printed for a run."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as output:
            path = Path(folder) / "tests.xml"
            path.write_text(run, encoding="utf-8")
            with mock.patch.object(sys, "argv", ["skipped.py", str(path)]):
                skipped.main()
        return output.getvalue().splitlines()

    def test_reasons(self):
        """Each reason is printed once, and a test without a reason is named."""
        self.assertEqual(self.printed(RUN), [
            "Skipped:", "  whole: sbatch is not installed", "  silent: without a reason",
            "  parts, a part of it: pyNastran is not installed"])

    def test_none(self):
        """A run in which nothing was skipped."""
        self.assertEqual(self.printed('<testsuite><testcase name="a" status="run"/></testsuite>'),
                         ["No test was skipped."])


if __name__ == "__main__":
    unittest.main()
