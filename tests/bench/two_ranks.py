#!/usr/bin/env python3
"""Speed-up of two ranks over one: implicit steps of plates of 200 000 unknowns, and the measured 25 J panel
by central differences, with cells of 1.5 mm up to .72 ms; with --sizes, elastic plates of 10 000 to 1 000 000 unknowns
in both ways. See README.md."""
import argparse
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]/'regress'))
from bench import DECK, ENVIRONMENT, PHASE
from solver_runs import change_deck

PANEL = pathlib.Path(__file__).parents[2]/'input/experiments/t700_m21_25J.nml'


def decks(steps):
    """Names and texts of the decks."""
    for kinematics, elements in (('linear', 131), ('von_karman', 100)):
        yield kinematics, DECK.format(kinematics=kinematics, elements=elements, step=1e-6, end=steps*1e-6,
                                      more='&solver /')
    yield 'panel', change_deck(PANEL.read_text(), ['time%end=7.2e-4'])


def decks_by_size():
    """Names and texts of decks of 1e4, 1e5 and 1e6 unknowns. A step by central differences is shorter on finer cells,
    some 500 to 700 of them are taken."""
    for elements in (29, 91, 288):
        text = DECK.format(kinematics='linear', elements=elements, step=1e-6, end=20e-6, more='&solver /')
        yield f'implicit {elements}', text
        yield f'central differences {elements}', change_deck(
            text.replace("  integrator='trapezoidal'", '').replace('step=1e-06  rho_inf=1', ''),
            ["time%integrator='central_difference'", f'time%end={3e-3/elements:.3g}'])


def phases_of(program, ranks, text):
    """Number of calls of each part of a run, and its wall-clock seconds."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, 'deck.nml').write_text(text)
        subprocess.run(['mpirun', '-n', str(ranks), program, f'{folder}/deck.nml', '--output', folder],
                       env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True)
        log, = pathlib.Path(folder).glob('*.log')
        return {name.strip(): (int(times), float(wall))
                for name, times, wall, _ in re.findall(PHASE, log.read_text(), re.MULTILINE)}


def main():
    """Print a line per deck."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('--factorization', default='automatic', help='of two ranks')
    parser.add_argument('--steps', type=int, default=300, help='of the plates')
    parser.add_argument('--sizes', action='store_true', help='elastic plates of several sizes instead')
    parser.add_argument('--repeat', type=int, default=3, help='runs of each, alternately; medians are printed')
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    for name, text in decks_by_size() if arguments.sizes else decks(arguments.steps):
        runs = [[], []]
        for _ in range(arguments.repeat):
            for ranks, kind in ((1, 'automatic'), (2, arguments.factorization)):
                deck = text.replace('&solver', f"&solver factorization='{kind}'")
                runs[ranks - 1].append(phases_of(program, ranks, deck))
        runs = [{part: statistics.median(run[part][1] for run in same) for part in same[0]} for same in runs]
        ratios = {part: runs[0][part]/runs[1][part] for part in ('steps', 'solve', 'factorization') if part in runs[0]}
        print(f'{name}: steps {runs[0]["steps"]:.1f} and {runs[1]["steps"]:.1f} s, one over two',
              ', '.join(f'{part} {ratio:.2f}' for part, ratio in ratios.items()), sep='; ', flush=True)


if __name__ == '__main__':
    main()
