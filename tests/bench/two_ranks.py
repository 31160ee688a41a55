#!/usr/bin/env python3
"""How much faster two ranks are than one, on plates of 200 000 unknowns and on the measured panel. See README.md."""
import argparse
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

from bench import DECK, ENVIRONMENT, PHASE

PANEL = pathlib.Path(__file__).parents[2]/'input/experiments/t700_m21_25J.nml'


def decks(steps):
    """Names and texts of the decks."""
    for kinematics, elements in (('linear', 131), ('von_karman', 100)):
        yield kinematics, DECK.format(kinematics=kinematics, elements=elements, step=1e-6, end=steps*1e-6,
                                      more='&solver /')
    panel = re.sub(r'(&mesh +).*', r'\1elements=26,40 patch=2e-3 core=48e-3,48e-3 cell=2e-3 /', PANEL.read_text())
    yield 'panel', re.sub(r'end=\S+', 'end=3.6e-4', panel.replace('friction=0.3', 'friction=0.3 zone=48e-3,48e-3'))


def phases_of(program, ranks, text):
    """Seconds on the wall of each part of a run."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, 'deck.nml').write_text(text)
        subprocess.run(['mpirun', '-n', str(ranks), program, f'{folder}/deck.nml', '--output', folder],
                       env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True)
        log, = pathlib.Path(folder).glob('*.log')
        return {name.strip(): float(wall) for name, _, wall, _ in re.findall(PHASE, log.read_text(), re.MULTILINE)}


def main():
    """Print a line a deck."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('--factorization', default='automatic', help='of two ranks')
    parser.add_argument('--steps', type=int, default=300, help='of the plates')
    parser.add_argument('--repeat', type=int, default=3, help='runs of each, in turns; medians are printed')
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    for name, text in decks(arguments.steps):
        runs = [[], []]
        for _ in range(arguments.repeat):
            for ranks, kind in ((1, 'automatic'), (2, arguments.factorization)):
                deck = text.replace('&solver', f"&solver factorization='{kind}'")
                runs[ranks - 1].append(phases_of(program, ranks, deck))
        runs = [{part: statistics.median(run[part] for run in same) for part in same[0]} for same in runs]
        ratios = {part: runs[0][part]/runs[1][part] for part in ('steps', 'solve', 'factorization', 'element forces')}
        rest = [run['steps'] - run['factorization'] - run['assembly'] for run in runs]
        print(f'{name}: steps {runs[0]["steps"]:.1f} and {runs[1]["steps"]:.1f} s, one over two',
              ', '.join(f'{part} {ratio:.2f}' for part, ratio in ratios.items()),
              f'without factorizations {rest[0]/rest[1]:.2f}', sep='; ', flush=True)


if __name__ == '__main__':
    main()
