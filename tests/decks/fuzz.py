#!/usr/bin/env python3
"""Modifies valid decks at random and runs `implam check` on them: it must accept or refuse each, with exit code 0
or 2, and never crash, hang or print a backtrace. Keys and groups that `implam explain` lists are inserted at random.

usage: fuzz.py IMPLAM [DECK ...] [--count N] [--seed S] [--keep FOLDER] [--run]

Without decks those in good/ are modified. Decks on which the program fails are kept in FOLDER. With --run decks stay
valid: numbers and keys change, and those that pass the check are run. They must end with exit code 0 or 3 within a
minute of processor time, with finite numbers only and a ledger that closes to a thousandth of the largest energy.
"""
import argparse
import csv
import math
import os
import random
import re
import resource
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eEdD][-+]?\d+)?")
EXTREMES = [b"0", b"-0.0", b"1", b"-1", b"1e-300", b"1e300", b"1e999", b"1e-999", b"1d30", b"9.99e29", b"NaN", b"Inf",
            b"-Infinity", b"2147483647", b"2147483648", b"-2147483648", b"99999999999999999999", b"1.5", b".", b"1e",
            b"+", b"1e+", b"0x7f", b"1e99999999999999999999", b"3*", b"0*1", b"10000*1", b"9999999999*1", b"'1'", b"",
            b"1" * 500]
PLAUSIBLE = [b"0", b"1", b"2", b"3", b"0.5", b"0.1", b"1e-3", b"0.02", b"1e-6", b"10", b"1e3", b"1e9", b"4, 4",
             b"0.02, 0.01", b"'a'"]
PIECES = [b"&", b"/", b"'", b'"', b"!", b"=", b",", b"(", b")", b"%", b"*", b"\n", b"\r", b"\0", b"\t", b"&end",
          b"&plate ", b"&material ", b"&time /", b"$", b";", b"2*'a'", b"'\n", b"//", b"\xff\xfe", b"\xc3\xa9",
          b" a=1 ", b".true.", b".false.", b"name='x'", b"T", b"-", b"e", b"x" * 5000, b"a=1 " * 300, b"'" * 301]


def vocabulary(program):
    """Every key that `implam explain` lists, with its group and its allowed words."""
    def explained(*words):
        return subprocess.run([program, "explain", *words], stdout=subprocess.PIPE, timeout=60, check=True).stdout

    known = []
    for group in re.findall(rb"^  &(\w+)", explained(), re.MULTILINE):
        for key, line in re.findall(rb"^  (\w+) .*\n +allowed: (.*)$", explained(group.decode()), re.MULTILINE):
            known.append((group, key, re.findall(rb"'[^']*'|\.true\.|\.false\.", line)))
    return known


def entry(known, chance):
    """A key with a valid or invalid value; sometimes in its own group."""
    group, key, words = chance.choice(known)
    values = chance.choices(words or PLAUSIBLE, k=chance.choice([1, 1, 1, 2, 3]))
    if chance.randrange(4) == 0:
        values = chance.choices(EXTREMES + PLAUSIBLE + [b"'x'", b".true."], k=chance.choice([1, 2]))
    text = b" " + key + b"=" + b", ".join(values) + b" "
    return b"\n&" + group + text + b"/\n" if chance.randrange(4) == 0 else text


def enter(deck, known, chance):
    """The deck with one more key, usually in its group, replacing an existing one or not."""
    text = entry(known, chance)
    if text.startswith(b"\n"):
        return deck + text
    key = text.split(b"=")[0].strip()
    if chance.randrange(4):
        deck = re.sub(rb"\b" + key + rb"\s*=[^=/\n]*(?=\s\w+\s*=|/|\n)", b"", deck)
    groups = [group for group, name, _ in known if name == key]
    places = [match.end() for match in re.finditer(rb"&(\w+)", deck) if match[1] in groups or chance.randrange(20) == 0]
    if not places:
        return deck + b"\n&" + groups[0] + text + b"/\n"
    place = chance.choice(places)
    return deck[:place] + text + deck[place:]


def spoil(deck, known, chance):
    """The deck with one random change."""
    start = chance.randrange(len(deck) + 1)
    end = min(len(deck), start + int(chance.expovariate(1 / 12)) + 1)
    kind = chance.randrange(12)
    if kind > 8:
        return enter(deck, known, chance)
    if kind == 0:
        flipped = bytearray(deck)
        for _ in range(chance.randint(1, 8)):
            flipped[chance.randrange(len(flipped))] ^= 1 << chance.randrange(8)
        return bytes(flipped)
    if kind == 1:
        return deck[:start]
    if kind == 2:
        return deck[:start] + deck[end:]
    if kind == 3:
        return deck[:end] + deck[start:end] * chance.choice([1, 1, 2, 40]) + deck[end:]
    if kind == 4:
        lines = deck.split(b"\n")
        chance.shuffle(lines)
        return b"\n".join(lines)
    if kind == 5:
        words = re.split(rb"([\s,=/]+)", deck)
        first, second = chance.randrange(len(words)), chance.randrange(len(words))
        words[first], words[second] = words[second], words[first]
        return b"".join(words)
    if kind in (6, 7):
        numbers = list(NUMBER.finditer(deck))
        if numbers:
            number = chance.choice(numbers)
            return deck[:number.start()] + chance.choice(EXTREMES) + deck[number.end():]
    return deck[:start] + chance.choice(PIECES) + deck[start:]


def fault(program, path):
    """The fault of the program's response to a deck, or None."""
    try:
        done = subprocess.run([program, "check", path], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60)
    except subprocess.TimeoutExpired:
        return "hangs"
    output = done.stdout.lower()
    if done.returncode not in (0, 2):
        return f"exit code {done.returncode}: {done.stdout[-300:]!r}"
    for sign in (b"backtrace", b"runtime error", b"sanitizer", b"sigsegv"):
        if sign in output:
            return f"{sign.decode()}: {done.stdout[-300:]!r}"
    if done.returncode == 2 and not output.strip():
        return "refuses without a word"
    return None


def alter(deck, known, chance):
    """The deck with one number or key changed to a reasonable value."""
    if chance.randrange(2):
        return enter(deck, known, chance)
    number = chance.choice(list(NUMBER.finditer(deck)))
    value = float(number[0].lower().replace(b"d", b"e"))*chance.choice([0, 0.01, 0.1, 0.5, 0.9, 2, 3, 10, 100, 1e4, -1])
    text = str(int(value)) if re.fullmatch(rb"[-+]?\d{1,18}", number[0]) else repr(value)
    return deck[:number.start()] + text.encode() + deck[number.end():]


def fault_of_run(program, path):
    """The fault of the run of a deck, or None; None if the check refuses the deck or its mesh is large."""
    if fault(program, path) or subprocess.run([program, "check", path], stdout=subprocess.DEVNULL).returncode:
        return fault(program, path)
    with open(path, "rb") as deck:
        counts = re.findall(rb"elements\s*=\s*(\d+)(?:\s*,\s*(\d+))?", deck.read())
    if counts and int(counts[-1][0])*int(counts[-1][1] or counts[-1][0]) > 900:
        return None
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, path, "--output", folder], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (60, 60)))
        if done.returncode == -9 and b" left, step " in done.stdout:
            # The run has many steps and takes its time.
            return None
        if done.returncode not in (0, 3) or b"backtrace" in done.stdout.lower():
            return f"exit code {done.returncode}: {done.stdout[-300:]!r}"
        for name in os.listdir(folder):
            if name.endswith("_history.csv"):
                with open(os.path.join(folder, name)) as lines:
                    return fault_of_history(list(csv.DictReader(line for line in lines if not line.startswith("#"))))
    return None


def fault_of_history(rows):
    """The fault of the numbers of a run, or None."""
    values = [{key: float(text) for key, text in row.items()} for row in rows]
    if not all(math.isfinite(value) for row in values for value in row.values()):
        return "numbers that are not finite"
    largest = max((abs(row[key]) for row in values for key in row if key.startswith("energy_")), default=0)
    unaccounted = max((abs(row["energy_error"]) for row in values), default=0)
    return f"{unaccounted:.2e} of {largest:.2e} energy error" if unaccounted > 1e-3*largest else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("decks", nargs="*")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", default=".")
    parser.add_argument("--run", action="store_true")
    asked = parser.parse_args()
    folder = os.path.join(HERE, "good")
    seeds = []
    for path in asked.decks or [os.path.join(folder, name) for name in sorted(os.listdir(folder))]:
        with open(path, "rb") as deck:
            seeds.append(deck.read())
    chance = random.Random(asked.seed)
    known = vocabulary(os.path.abspath(asked.program))
    if not known:
        sys.exit("`implam explain` lists no keys.")
    failed = 0
    with tempfile.TemporaryDirectory() as work:
        path = os.path.join(work, "fuzz.nml")
        for number in range(asked.count):
            deck = chance.choice(seeds)
            for _ in range(chance.choice([1, 1, 2, 4, 10])):
                deck = alter(deck, known, chance) if asked.run else spoil(deck or b"&", known, chance)
            with open(path, "wb") as file:
                file.write(deck[:500000])
            wrong = (fault_of_run if asked.run else fault)(os.path.abspath(asked.program), path)
            if wrong:
                failed += 1
                kept = os.path.join(asked.keep, f"fuzz-{asked.seed}-{number}.nml")
                os.replace(path, kept)
                print(f"{kept}: {wrong}")
    print(f"{asked.count} decks, {failed} with a failure of the program")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
