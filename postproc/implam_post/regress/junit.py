"""Results of runs as JUnit XML for continuous integration."""

import re
from collections.abc import Sequence
from xml.etree import ElementTree

from implam_post.regress.compare import table
from implam_post.regress.runs import Outcome

_NOT_XML = re.compile(r"[^\t\n\r\u0020-\uD7FF\uE000-\uFFFD\U00010000-\U0010FFFF]")


def junit(outcomes: Sequence[Outcome], seconds: float) -> str:
    """Return the XML with a test case per run: an error if it could not be compared, a failure if it differs."""
    errors = sum(bool(outcome.fault) for outcome in outcomes)
    counts = {"tests": len(outcomes), "failures": sum(not outcome.passed for outcome in outcomes) - errors,
              "errors": errors}
    totals = {name: str(number) for name, number in counts.items()} | {"time": f"{seconds:.3f}"}
    root = ElementTree.Element("testsuites", totals)
    suite = ElementTree.SubElement(root, "testsuite", {"name": "implam-regress", **totals})
    for outcome in outcomes:
        case = ElementTree.SubElement(suite, "testcase", {"classname": outcome.expectations.path.stem,
                                                          "name": outcome.variant.name,
                                                          "time": f"{outcome.seconds:.3f}"})
        compared = table(outcome.comparisons) if outcome.comparisons else ""
        if outcome.verdict:
            kind = "error" if outcome.fault else "failure"
            verdict = ElementTree.SubElement(case, kind, {"message": _clean(outcome.verdict)})
            verdict.text = _clean(compared or outcome.verdict)
        elif compared:
            ElementTree.SubElement(case, "system-out").text = compared
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _clean(text: str) -> str:
    """Return a text with characters that XML does not allow replaced."""
    return _NOT_XML.sub("?", text)
