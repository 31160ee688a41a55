"""Turns a test file (.pf) into Fortran: asserts become calls with their positions, and a module
MODULE_run is added that runs every test of the file. Usage: preprocess.py IN.pf OUT.F90"""

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

DIRECTIVE = re.compile(r"^\s*@(\w+)\s*(?:\((.*)\))?\s*$", re.I)
SUBROUTINE = re.compile(r"^\s*(?:(?:recursive|impure|module)\s+)*subroutine\s+(\w+)\s*(?:\(\s*(\w*)\s*\))?", re.I)
TYPE = re.compile(r"^\s*type\b[^!]*::\s*(\w+)", re.I)
ARGUMENT = re.compile(r"^\s*(?:class|type)\s*\(\s*(\w+)\s*\)[^!]*::\s*(\w+)", re.I)
OPTIONS = {"npes", "ifdef", "ifndef", "testparameters", "constructor"}
MODULE = re.compile(r"^\s*module\s+(?!procedure\b|subroutine\b|function\b)(\w+)\s*(?:!.*)?$", re.I)


@dataclass
class Test:
    """A test, or (without a name) the one that the next subroutine will be."""

    options: dict
    name: str = ""
    argument: str = ""
    type: str = ""
    disabled: bool = False


@dataclass
class Suite:
    """The declarations by directives of one file."""

    module: str = ""
    name: str = ""
    tests: list = field(default_factory=list)
    before: str = ""
    after: str = ""
    case: str = ""
    case_options: dict = field(default_factory=dict)
    parameter: str = ""


def split_options(text):
    """'npes=[1,2], ifdef=X' as a dictionary with lower-case keys."""
    parts, depth = [""], 0
    for character in text or "":
        depth += (character in "([{") - (character in ")]}")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    pairs = [part.partition("=") for part in parts if part.strip()]
    return {key.strip().lower(): value.strip() for key, _, value in pairs}


def listed(text):
    """Items of '[1,2]' or '{f()}'."""
    inner = text.strip()[1:-1]
    return [item.strip() for item in inner.split(",")] if text.strip().startswith("[") else [inner]


class Translator:
    """Reads one file line by line."""

    def __init__(self, path):
        """Start at the beginning of a file."""
        self.path = path
        self.suite = Suite()
        self.awaited = None  # what the next subroutine or type is
        self.out = [f'#line 1 "{path}"']

    def error(self, number, sentence):
        """Stop with a sentence about a line."""
        sys.exit(f"{self.path}:{number}: {sentence}")

    def translate(self, text):
        """Return the whole file in Fortran."""
        for number, line in enumerate(text.splitlines(), 1):
            found = DIRECTIVE.match(line)
            if found:
                self.directive(number, found.group(1).lower(), found.group(1), found.group(2))
            elif line.lstrip().startswith("@"):
                self.error(number, "a directive is on one line with nothing after it")
            else:
                self.declaration(number, line)
                self.out.append(line)
        if self.awaited:
            self.error(number, "the last directive has nothing to apply to")
        if self.suite.module.lower() != Path(self.path).stem.lower():
            self.error(1, "the module must have the name of the file")
        return "\n".join(self.out + run_module(self.suite)) + "\n"

    def directive(self, number, keyword, spelling, text):
        """Replace a directive by Fortran, or store what it applies to."""
        if keyword.startswith(("assert", "mpiassert")):
            name = spelling[3:] if keyword.startswith("mpi") else spelling
            arguments = f"{text}, " if text and text.strip() else ""
            self.out.append(f"call {name}({arguments}location=SourceLocation('{self.path}', {number}))")
            self.out += [] if keyword.startswith("mpi") else ["if (anyExceptions()) return"]
            self.out.append(f'#line {number + 1} "{self.path}"')
            return
        self.out.append("")
        options = split_options(text)
        unknown = set(options) - OPTIONS
        if keyword in ("test", "testcase") and unknown:
            self.error(number, f"option {', '.join(sorted(unknown))} of @{spelling} is not known here")
        if keyword == "test":
            self.awaited = Test(options)
        elif keyword == "disable" and isinstance(self.awaited, Test):
            self.awaited.disabled = True
        elif keyword in ("before", "after", "testparameter"):
            self.awaited = keyword
        elif keyword == "testcase":
            self.awaited, self.suite.case_options = keyword, options
        elif keyword == "suite":
            self.suite.name = options.get("name", "").strip("'\"")
        else:
            self.error(number, f"@{spelling} is not known here")

    def declaration(self, number, line):
        """Store the names to which the preceding directives apply."""
        module, subroutine, kind = MODULE.match(line), SUBROUTINE.match(line), TYPE.match(line)
        if module and not self.suite.module:
            self.suite.module = module.group(1)
        if subroutine and isinstance(self.awaited, Test):
            self.awaited.name, self.awaited.argument = subroutine.group(1), subroutine.group(2) or ""
            self.suite.tests.append(self.awaited)
            self.awaited = None
        elif subroutine and self.awaited in ("before", "after"):
            setattr(self.suite, self.awaited, subroutine.group(1))
            self.awaited = None
        elif subroutine and self.awaited:
            self.error(number, f"@{self.awaited} applies to a type")
        elif kind and self.awaited in ("testcase", "testparameter"):
            setattr(self.suite, self.awaited[4:], kind.group(1))
            self.awaited = None
        argument = ARGUMENT.match(line)
        last = self.suite.tests[-1] if self.suite.tests else None
        if argument and last and last.argument.lower() == argument.group(2).lower() and not last.type:
            last.type = argument.group(1)


def run_module(suite):
    """The module that runs the tests."""
    lines = [
        f"module {suite.module}_run",
        "  use pfunit",
        "  use test_runs, only: test_run",
        f"  use {suite.module}",
        "  implicit none",
        "  private",
        "  public :: run_tests",
        "contains",
        "  subroutine run_tests(run)",
        "    type(test_run), intent(inout) :: run",
    ]
    calls, bodies = [], []
    for test in suite.tests:
        guard = [f"#{key} {test.options[key]}" for key in ("ifdef", "ifndef") if key in test.options]
        end = ["#endif"] * len(guard)
        title = f"{suite.name or suite.module}.{test.name}"
        if test.disabled:
            calls += [*guard, f"    call run%skips('{title}')", *end]
            continue
        calls += [*guard, f"    call run_{test.name}(run)", *end]
        bodies += [*guard, *run_test(suite, test, title), *end]
    return lines + calls + ["  end subroutine run_tests"] + bodies + [f"end module {suite.module}_run"]


def run_test(suite, test, title):
    """The subroutine that runs one test once for each parameter and number of processes."""
    options = {**suite.case_options, **test.options} if test.type == suite.case else test.options
    case, build, loop, label = test.type, "", [], f"'{title}'"
    declarations = [f"    type({case}), allocatable :: ground"] if case else []
    if "testparameters" in options:
        declarations += [f"    type({suite.parameter}), allocatable :: parameters(:)", "    integer :: i"]
        loop = [f"    parameters = {listed(options['testparameters'])[0]}", "    do i = 1, size(parameters)"]
        build, label = "parameters(i)", label + "//'['//parameters(i)%toString()//']'"
    lines = [f"  subroutine run_{test.name}(run)", "    type(test_run), intent(inout) :: run", *declarations, *loop]
    constructor = options.get("constructor")
    for processes in listed(options.get("npes", "[1]")):
        suffix = f"//' (npes={processes})'" if "npes" in options else ""
        lines += [f"    if (run%begins({label}{suffix}, {processes})) then"]
        if case:
            lines += [f"      ground = {constructor}({build})" if constructor else "      allocate (ground)"]
            lines += ["      call ground%join(run%communicator)", "      call ground%setUp()"]
        lines += [f"      call {suite.before}()"] if suite.before else []
        lines += [f"      call {test.name}({'ground' if case else ''})"]
        lines += [f"      call {suite.after}()"] if suite.after else []
        lines += ["      call ground%tearDown()", "      deallocate (ground)"] if case else []
        lines += ["    end if", "    call run%ends()"]
    return lines + (["    end do"] if loop else []) + [f"  end subroutine run_{test.name}"]


if __name__ == "__main__":
    source, target = sys.argv[1:]
    Path(target).write_text(Translator(source).translate(Path(source).read_text(encoding="utf-8")), encoding="utf-8")
