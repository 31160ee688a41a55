#!/usr/bin/env python3
"""How much faster two ranks are than one, on plates of 200 000 unknowns and on the measured panel. See README.md.

With --end it is the 25 J deck as it is, ended there. Where plies crack and faces part, rounding decides how many
factorizations and solves a run takes, on any number of ranks. So its runs strike at speeds that are apart by 4e-13 of
them, and what two ranks would take for as many factorizations and solves as one is told, too."""
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
    """How often each part of a run came, and its seconds on the wall."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, 'deck.nml').write_text(text)
        subprocess.run(['mpirun', '-n', str(ranks), program, f'{folder}/deck.nml', '--output', folder],
                       env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True)
        log, = pathlib.Path(folder).glob('*.log')
        return {name.strip(): (int(times), float(wall))
                for name, times, wall, _ in re.findall(PHASE, log.read_text(), re.MULTILINE)}


def panel_as_it_is(program, end, repeat):
    """Print a line a pair of runs, and how much faster two ranks are over all of them."""
    totals = [0, 0, 0]
    for k in range(repeat):
        text = re.sub(r'end=\S+', f'end={end}', PANEL.read_text())
        text = text.replace('velocity=5.000', f'velocity={5 + 2e-12*k:.12f}')
        one, two = (phases_of(program, ranks, text) for ranks in (1, 2))
        # Both are counted in full, also the solves inside other parts.
        likened = two['steps'][1] + sum((one[part][0]/two[part][0] - 1)*two[part][1]
                                        for part in ('factorization', 'solve'))
        totals = [sum(pair) for pair in zip(totals, (one['steps'][1], two['steps'][1], likened), strict=True)]
        print(*(f'{run["steps"][1]:.1f} s with {run["factorization"][0]} factorizations and {run["solve"][0]} solves'
                for run in (one, two)), sep=', on two ranks ', flush=True)
    print(f'one over two: {totals[0]/totals[1]:.2f}; for as many factorizations and solves {totals[0]/totals[2]:.2f}')


def main():
    """Print a line a deck."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('--factorization', default='automatic', help='of two ranks')
    parser.add_argument('--steps', type=int, default=300, help='of the plates')
    parser.add_argument('--repeat', type=int, default=3, help='runs of each, in turns; medians are printed')
    parser.add_argument('--end', type=float, help='time at which the 25 J deck ends, in s')
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    if arguments.end:
        panel_as_it_is(program, arguments.end, arguments.repeat)
        return
    for name, text in decks(arguments.steps):
        runs = [[], []]
        for _ in range(arguments.repeat):
            for ranks, kind in ((1, 'automatic'), (2, arguments.factorization)):
                deck = text.replace('&solver', f"&solver factorization='{kind}'")
                runs[ranks - 1].append(phases_of(program, ranks, deck))
        runs = [{part: statistics.median(run[part][1] for run in same) for part in same[0]} for same in runs]
        ratios = {part: runs[0][part]/runs[1][part] for part in ('steps', 'solve', 'factorization', 'element forces')}
        rest = [run['steps'] - run['factorization'] - run['assembly'] for run in runs]
        print(f'{name}: steps {runs[0]["steps"]:.1f} and {runs[1]["steps"]:.1f} s, one over two',
              ', '.join(f'{part} {ratio:.2f}' for part, ratio in ratios.items()),
              f'without factorizations {rest[0]/rest[1]:.2f}', sep='; ', flush=True)


if __name__ == '__main__':
    main()
