#!/usr/bin/env python3
"""Compares the output of `implam check` with the expected faults of decks.

usage: check_decks.py IMPLAM

Every deck in bad/ begins with one comment for each fault, `! expect LINE: FRAGMENT`; the program must end with
exit code 2 and report exactly these faults, one a line, each as `FILE:LINE: ...FRAGMENT...` (LINE 0: the deck as a
whole, reported as `FILE: ...`). The decks in good/ must pass, with the warnings that `! expect-warning` lists.
Files that no editor would write are generated.
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
EXPECTATION = re.compile(rb"^! expect(-warning)? (\d+): (.*?)\r?$", re.MULTILINE)


def run(program, path):
    """Exit code and output lines of a check that must be fast and must not use MPI, which cannot start here."""
    done = subprocess.run([program, "check", path], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60,
                          env=dict(os.environ, OMPI_MCA_pml="none"))
    return done.returncode, done.stdout.decode("utf-8", "replace").splitlines()


def complaints(program, path, expected_code, errors, warnings):
    """Differences of the program's output from the expected one."""
    code, lines = run(program, path)
    found = [line for line in lines if line.startswith(path + ":") and not line.endswith(": no errors.")]
    wrong = []
    if code != expected_code:
        wrong.append(f"exit code {code} instead of {expected_code}")
    if any("backtrace" in line.lower() for line in lines):
        wrong.append("a backtrace")
    for kind, expected in (("error", errors), ("warning", warnings)):
        printed = [line for line in found if (": warning: " in line) == (kind == "warning")]
        if len(printed) != len(expected) and (kind == "error" or code == 0):
            wrong.append(f"{len(printed)} {kind}s instead of {len(expected)}")
        for line_number, fragment in expected:
            head = f"{path}:{line_number}: " if line_number else f"{path}: "
            if not any(line.startswith(head) and fragment in line for line in printed):
                wrong.append(f"no {kind} `{head}... {fragment}`")
    if wrong:
        wrong.extend("  printed: " + line[:200] for line in lines[:12])
    return wrong


def expectations(path):
    """The errors and warnings that a deck expects."""
    with open(path, "rb") as deck:
        found = EXPECTATION.findall(deck.read())
    errors = [(int(line), text.decode()) for is_warning, line, text in found if not is_warning]
    warnings = [(int(line), text.decode()) for is_warning, line, text in found if is_warning]
    return errors, warnings


def made_decks(folder):
    """Decks as bytes: name, exit code, errors, warnings."""
    with open(os.path.join(HERE, "good", "impact.nml"), "rb") as deck:
        good = deck.read()
    length = len(good.splitlines())
    yield "empty", b"", 2, [(0, "the deck is empty")], []
    yield "blank", b" \n\t\n", 2, [(0, "the deck is empty")], []
    yield "nul", good + b"&out\0put /\n", 2, [(length + 1, "character 5 of the line has code 0")], []
    yield "bell", good + b"! \a\n", 2, [(length + 1, "code 7, which is not printable")], []
    yield "machine_code", bytes(range(256)) * 40, 2, [(1, "code 0, which is not printable")], []
    yield "old_mac_lines", good.replace(b"\n", b"\r"), 2, [(1, "code 13, which is not printable")], []
    yield "one_long_line", good + b"! " + b"x" * 900000, 2, [(length + 1, "longer than 4000 characters")], []
    yield "ten_megabytes", b"&plate" + b" " * 10000000, 4, [(0, "has more than 1000000 bytes")], []
    yield "many_values", good + b"&output history_every=9999*1 9999*2 /\n", 2, [(length + 1, "more than 10000")], []
    yield "many_faults", b"&plate " + b"a=1 " * 500, 2, None, []
    yield "windows_lines", good.replace(b"\n", b"\r\n"), 0, [], []
    yield "byte_order_mark", b"\xef\xbb\xbf" + good, 0, [], []
    yield "no_last_line_end", good.rstrip(), 0, [], []
    yield "latin_title", good.replace(b"drop", b"f\xe4llt"), 0, [], []


def check_made_decks(program):
    """Generated decks, and paths that are no decks."""
    wrong = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, content, code, errors, warnings in made_decks(folder):
            path = os.path.join(folder, name + ".nml")
            with open(path, "wb") as deck:
                deck.write(content)
            if errors is None:
                found_code, lines = run(program, path)
                wrong[name] = [] if found_code == code and len(lines) < 120 else [f"{found_code}, {len(lines)} lines"]
            else:
                wrong[name] = complaints(program, path, code, errors, warnings)
        missing = os.path.join(folder, "missing.nml")
        wrong["missing"] = complaints(program, missing, 4, [(0, "there is no such file")], [])
        wrong["folder"] = complaints(program, folder, 4, [(0, "is a folder, not a file")], [])
    return wrong


def main():
    program = os.path.abspath(sys.argv[1])
    wrong = check_made_decks(program)
    for kind, code in (("bad", 2), ("good", 0)):
        folder = os.path.join(HERE, kind)
        for name in sorted(os.listdir(folder)):
            path = os.path.join(folder, name)
            errors, warnings = expectations(path)
            if kind == "bad" and not errors:
                wrong[name] = ["the deck expects no fault"]
            else:
                wrong[name] = complaints(program, path, code, errors, warnings)
    failed = {name: lines for name, lines in wrong.items() if lines}
    for name, lines in failed.items():
        print(f"{name}:")
        print("\n".join("  " + line for line in lines))
    print(f"{len(wrong)} decks, {len(failed)} not as expected")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
