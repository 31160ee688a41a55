#!/usr/bin/env python3
"""Histories of two programs byte for byte, on all decks of input/: python3 equal_results.py OLD NEW FOLDER [NAME ...]

A deck that the old program does not finish within --limit seconds is cut: its end is the share --share of the deck's.
Results of the old program stay in FOLDER and are used again. Decks that continue from the result of another deck take
it from the folder of the same program."""
import argparse
import concurrent.futures
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]/'regress'))
from solver_runs import change_deck

INPUT = pathlib.Path(__file__).parents[2]/'input'
EXIT_DECK = 2
END = re.compile(r'^(&time\b[^/]*?\bend=)(\S+)', re.MULTILINE)


def run(program, path, output, limit):
    """Exit code of a run; None if it takes too long."""
    shutil.rmtree(output, ignore_errors=True)
    try:
        return subprocess.run([program, path, '--output', output], cwd=path.parent, timeout=limit, check=False,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
    except subprocess.TimeoutExpired:
        return None


def old_result(name, folder, options):
    """Exit code of the old program and path of the deck, cut if it takes too long."""
    place = folder/'old'/name.replace('/', '+')
    deck = place/'deck.nml'
    if (place/'code').exists():
        return int((place/'code').read_text()), deck
    place.mkdir(parents=True, exist_ok=True)
    text = INPUT.joinpath(name).read_text()
    deck.write_text(text)
    code = run(options.old, deck, place/'output', options.limit)
    found = END.search(text)
    if code is None and found:
        end = float(found[2].lower().replace('d', 'e'))
        share = options.share
        while share < 1 and code in (None, EXIT_DECK):
            # Very short runs may not pass the check.
            deck.write_text(change_deck(text, [f'time%end={end*share!r}']))
            code = run(options.old, deck, place/'output', 10*options.limit)
            share *= 4
    (place/'code').write_text(str(-1 if code is None else code))
    return (-1 if code is None else code), deck


def contents(path):
    """Bytes of a file; none if there is no such file."""
    return path.read_bytes() if path.exists() else b''


def compared(name, folder, options):
    """A line on the equality of the results."""
    code, deck = old_result(name, folder, options)
    cut = '' if deck.read_text() == INPUT.joinpath(name).read_text() else ', cut'
    if code < 0:
        return name, f'not compared, too long{cut}', None
    output = folder/'new'/name.replace('/', '+')/'output'
    output.parent.mkdir(parents=True, exist_ok=True)
    new_code = run(options.new, deck, output, 20*options.limit)
    old_files = sorted(path.name for path in (deck.parent/'output').glob('*.csv'))
    different = [file for file in old_files if contents(output/file) != contents(deck.parent/'output'/file)]
    if new_code == code and not old_files:
        return name, f'not compared, exit code {code} without a history{cut}', None
    equal = new_code == code and not different
    lines = sum(contents(deck.parent/'output'/file).count(b'\n') for file in old_files)
    verdict = 'equal' if equal else f'DIFFERENT {" ".join(different)}'
    return name, f'{verdict}, exit code {code}, {lines} lines{cut}', equal


def main():
    """Compare and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('old')
    parser.add_argument('new')
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('names', nargs='*')
    parser.add_argument('--limit', type=float, default=60)
    parser.add_argument('--share', type=float, default=0.02)
    parser.add_argument('--jobs', type=int, default=1)
    options = parser.parse_args()
    options.folder = options.folder.resolve()
    names = options.names or sorted(str(path.relative_to(INPUT)) for path in INPUT.rglob('*.nml'))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        lines = list(pool.map(lambda name: compared(name, options.folder, options), names))
    for name, line, _ in lines:
        print(f'{name}: {line}')
    results = [equal for _, _, equal in lines]
    print(f'{results.count(True)} equal, {results.count(False)} different, {results.count(None)} not compared')
    sys.exit(False in results)


if __name__ == '__main__':
    main()
