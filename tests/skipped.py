"""Prints the tests that were skipped, completely or in part, with their reasons.
Usage: skipped.py FILE     (what ctest --output-junit has written)"""

import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

# Output of skipped tests: of scripts at the beginning of a line, of unittest and the framework after the test's name.
SAID = re.compile(r"^(?:.*\.\.\. |\S+: )?skipped:? (.+)$", re.MULTILINE)


def reasons(output):
    """Return the reasons in the output of a test, each once."""
    return list(dict.fromkeys(reason.strip("'\"") for reason in SAID.findall(output)))


def main():
    """Print a line per reason."""
    lines = []
    for case in ElementTree.parse(Path(sys.argv[1])).getroot().iter("testcase"):
        whole = case.get("status") == "notrun"
        printed = reasons(case.findtext("system-out") or "")
        if whole and not printed:
            printed = ["without a reason"]
        lines += [f"  {case.get('name')}{'' if whole else ', a part of it'}: {reason}" for reason in printed]
    print("\n".join(["Skipped:", *lines]) if lines else "No test was skipped.")


if __name__ == "__main__":
    main()
