#!/usr/bin/env python3
"""Adds a key, a warning or a result by a patch, which may change one folder, two sources at most, and its tests.

usage: check_example.py PATCH... --compiler MPIFORT --modules FOLDER --tiers TIER... --objects OBJECT...
       --libraries LIBRARY... [FLAG...]

Libraries may begin with `lib:`, as those that begin with a dash would be taken for options.

The patches, of one folder, are applied to a copy of it and of its tests. The copy is compiled with the modules of the
folders before it, as in the build. Then the unchanged table of `case` is compiled with the copy and must explain new
keys; and the patches' unit tests are run.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
FRAMEWORK = os.path.join(ROOT, "tests", "framework")
SOURCES_ALLOWED = 2
EXPLAIN = """program explain_group
  use deck_explain, only: explain
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use errors, only: error_t
  use text, only: line_t
  implicit none
  type(vocabulary_t) :: vocabulary
  type(line_t), allocatable :: lines(:)
  type(error_t), allocatable :: error
  integer :: i
  call load_deck_table(vocabulary)
  call explain(vocabulary, '{group}', lines, error)
  do i = 1, size(lines)
    print '(a)', lines(i)%text
  end do
end program explain_group
"""


def run(*words, **settings):
    """Runs a command; exits with its output if it fails."""
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **settings)
    if done.returncode:
        sys.exit(f"{' '.join(words[:4])} ... failed:\n{done.stdout}")
    return done.stdout


def one_folder(patch):
    """The folder of src that the patch changes; it must be the only one besides its tests."""
    paths = re.findall(r"^\+\+\+ b/(\S+)$", patch, re.MULTILINE)
    folders = {path.split("/")[1] for path in paths if path.startswith("src/")}
    if len(folders) != 1:
        sys.exit(f"the patch changes the folders {sorted(folders)} of src, not one")
    folder = folders.pop()
    sources = [path for path in paths if path.startswith("src/")]
    if len(sources) > SOURCES_ALLOWED:
        sys.exit(f"the patch changes {len(sources)} sources, more than {SOURCES_ALLOWED}")
    strangers = [path for path in paths if not path.startswith((f"src/{folder}/", f"tests/unit/{folder}/"))]
    if strangers:
        sys.exit(f"the patch changes {strangers} beside src/{folder} and its tests")
    return folder, [path for path in paths if path.endswith(".pf")]


def in_order(folder):
    """The sources of a folder in the order of their dependencies."""
    uses, module_of = {}, {}
    for name in sorted(os.listdir(folder)):
        if name.endswith(".f90"):
            with open(os.path.join(folder, name), encoding="utf-8") as source:
                text = source.read()
            path = os.path.join(folder, name)
            module_of[re.search(r"^module (\w+)", text, re.MULTILINE)[1]] = path
            uses[path] = re.findall(r"^ *use (?:, *intrinsic *:: *)?(\w+)", text, re.MULTILINE)
    order = []

    def visit(path):
        for module in uses[path]:
            if module in module_of and module_of[module] != path:
                visit(module_of[module])
        if path not in order:
            order.append(path)

    for path in uses:
        visit(path)
    return order


class Workplace:
    """A folder in which sources are compiled."""

    def __init__(self, folder, asked):
        self.folder, self.asked = folder, asked

    def compile(self, sources, layers, flags=()):
        """Compiles sources with the modules compiled here before and those of some layers."""
        found = [f"-I{os.path.join(self.asked.modules, layer)}" for layer in layers]
        run(self.asked.compiler, "-c", "-O0", *flags, "-I.", *found, *sources, cwd=self.folder)
        return [os.path.join(self.folder, os.path.splitext(os.path.basename(source))[0] + ".o") for source in sources]

    def link(self, name, objects):
        """Links a program with the required objects of the build; those compiled here have precedence."""
        run("ar", "rcs", "lower.a", *self.asked.objects, cwd=self.folder)
        libraries = [word.removeprefix("lib:") for word in self.asked.libraries]
        run(self.asked.compiler, *objects, "lower.a", *libraries, "-o", name, cwd=self.folder)
        return os.path.join(self.folder, name)


def explain_keys(work, layers, patch):
    """Checks that the unchanged table of `case` explains the keys that a patch of a deck's rows adds."""
    if not re.search(r"^\+\+\+ b/src/\w+/\w+_deck\.f90$", patch, re.MULTILINE):
        return []
    added = re.findall(r"^\+ +'(\w+) \| (\w+) \|", patch, re.MULTILINE)
    if not added:
        sys.exit("the patch adds no key")
    with open(os.path.join(work.folder, "explain_group.f90"), "w", encoding="utf-8") as source:
        source.write(EXPLAIN.format(group=added[0][0]))
    sources = [os.path.join(ROOT, "src", "case", "deck_table.f90"), "explain_group.f90"]
    printed = run(work.link("explain", work.compile(sources, layers)))
    for _, key in added:
        if not re.search(rf"^  {key} ", printed, re.MULTILINE):
            sys.exit(f"the table does not explain {key}:\n{printed}")
    return [f"{group}%{key}" for group, key in added]


def run_tests(work, layers, tests, objects):
    """Compiles and runs the patch's tests with the replacement of pFUnit."""
    run(sys.executable, os.path.join(FRAMEWORK, "generate_asserts.py"), os.path.join(work.folder, "asserts.f90"))
    names = ["test_failures", "test_cases", "comparisons", "asserts", "test_runs", "funit", "pfunit"]
    sources = ["asserts.f90" if name == "asserts" else os.path.join(FRAMEWORK, name + ".f90") for name in names]
    sources.append(os.path.join(ROOT, "tests", "support", "deck_groups.f90"))
    with open(os.path.join(FRAMEWORK, "driver.f90.in"), encoding="utf-8") as template:
        driver = template.read()
    modules = [os.path.splitext(os.path.basename(test))[0] for test in tests]
    for module, test in zip(modules, tests, strict=True):
        run(sys.executable, os.path.join(FRAMEWORK, "preprocess.py"), test, module + ".F90", cwd=work.folder)
        sources.append(module + ".F90")
    uses, calls = "  use {0}_run, only: run_{0} => run_tests", "  call run_{0}(run)"
    for mark, line in (("@DRIVER_USES@", uses), ("@DRIVER_CALLS@", calls)):
        driver = driver.replace(mark, "\n".join(line.format(name) for name in modules))
    with open(os.path.join(work.folder, "driver.f90"), "w", encoding="utf-8") as source:
        source.write(driver)
    compiled = work.compile([*sources, "driver.f90"], layers, ["-ffree-line-length-none"])
    run("ar", "rcs", "changed.a", *objects, cwd=work.folder)
    return run(work.link("run_tests", [*compiled, "changed.a"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("patches", nargs="+")
    for name in ("compiler", "modules"):
        parser.add_argument("--" + name, required=True)
    for name in ("tiers", "objects", "libraries"):
        parser.add_argument("--" + name, nargs="*", default=[])
    asked, flags = parser.parse_known_args()
    tests = []
    for path in asked.patches:
        with open(path, encoding="utf-8") as file:
            patch = file.read()
        folder, added = one_folder(patch)
        tests += added
    tiers = [tier.split() for tier in " ".join(asked.tiers).split("/")]
    lower = [layer for tier in tiers[:[folder in tier for tier in tiers].index(True)] for layer in tier]
    every = [layer for tier in tiers for layer in tier]
    with tempfile.TemporaryDirectory() as place:
        for part in (f"src/{folder}", f"tests/unit/{folder}"):
            if os.path.isdir(os.path.join(ROOT, part)):
                shutil.copytree(os.path.join(ROOT, part), os.path.join(place, part))
        for path in asked.patches:
            run("patch", "-p1", "--no-backup-if-mismatch", "-i", os.path.abspath(path), cwd=place)
        work = Workplace(place, asked)
        # Last those of the build: modules that it generates.
        objects = work.compile(in_order(os.path.join(place, "src", folder)), [*lower, folder], flags)
        keys = explain_keys(work, every, patch)
        printed = run_tests(work, every, [os.path.join(place, test) for test in tests], objects)
    names = keys or [os.path.splitext(os.path.basename(path))[0] for path in asked.patches]
    print(f"src/{folder} and its tests alone: {', '.join(names)}; {printed.strip().splitlines()[-1]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
