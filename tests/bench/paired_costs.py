#!/usr/bin/env python3
"""Cost of runs relative to an older program: implicit steps of large plates, Sun and Chen's plate, thresholds,
specimens under load steps, and impacts by central differences that delaminate and break. Both programs run alternately.
See README.md."""
import argparse
import os
import pathlib
import re
import statistics
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]/'regress'))
from bench import DECK, PHASE, history, run_deck
from solver_runs import change_deck

INPUT = pathlib.Path(__file__).parents[2]/'input'
IMPLICIT_PEANUT = ["time%integrator='generalized_alpha'", 'time%step=16e-6']


def plate(kinematics, elements, steps):
    """A plate of about 60 000 unknowns with steps of 1 us."""
    return DECK.format(kinematics=kinematics, elements=elements, step=1e-6, end=steps*1e-6, more='')


def stored(folder, name, *settings):
    """A deck of the folder input, readable by older programs."""
    text = folder.joinpath(name).read_text().replace("  units='SI' /", ' /').replace('mass_scaling=6', '')
    return change_deck(text, settings)


def impact(folder, name, *settings):
    """A deck of the folder input with changed keys, by central differences."""
    return change_deck(folder.joinpath(name).read_text(), ["time%integrator='central_difference'", *settings])


PANEL, ANGLES = 'experiments/t700_m21_25J.nml', 'experiments/im7_8552_d7136_30J.nml'
COARSE = ['mesh%elements=20, 30', 'mesh%cell=3e-3']
PLIES_32 = ["laminate%stacking='[45/0/-45/90]4s'", 'impactor%energy=27', 'time%end=2e-3', 'output%history_every=4e-6']

# Name: deck, whether only the steps are compared, and the limit of the ratio; for sun_chen that of the difference, s.
CASES = {
    'plate, linear, a step': (lambda folder: plate('linear', 71, 100), True, 1.4),
    'plate, von Karman, a step': (lambda folder: plate('von_karman', 55, 100), True, 1.4),
    'sun_chen': (lambda folder: stored(folder, 'sun_chen.nml'), False, 0.2),
    'dcb': (lambda folder: stored(folder, 'verify/dcb.nml'), False, 2),
    'enf': (lambda folder: stored(folder, 'verify/enf.nml'), False, 2),
    'mmb': (lambda folder: stored(folder, 'verify/mmb.nml'), False, 2),
    'li2002': (lambda folder: stored(folder, 'li2002.nml'), False, 2),
    'peanut, implicit': (lambda folder: stored(folder, 'peanut.nml', *IMPLICIT_PEANUT), False, 2),
    'crossply_threshold': (lambda folder: stored(folder, 'crossply_threshold.nml'), False, 2),
    'peanut': (lambda folder: impact(folder, 'peanut.nml'), False, 0.5),
    '22 interfaces': (lambda folder: impact(folder, ANGLES), False, 0.65),
    '32 plies, 2 ms': (lambda folder: impact(folder, ANGLES, *PLIES_32), False, 0.65),
    '25 J, cells of 1.5 mm': (lambda folder: impact(folder, PANEL), False, 0.65),
    '25 J, cells of 3 mm': (lambda folder: impact(folder, PANEL, *COARSE), False, 0.7),
    'breaking rounds': (lambda folder: impact(folder, 'small/breaking_rounds.nml'), False, 0.7),
    'breaking panel': (lambda folder: impact(folder, 'breaking_panel.nml'), False, 0.7),
    'sun_chen, central differences': (lambda folder: impact(folder, 'sun_chen.nml'), False, 1),
}


def measure(program, text, steps_alone):
    """Processor seconds of a run, or of its steps, and the largest force."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        seconds = run_deck(program, text, folder)
        if steps_alone:
            log, = folder.glob('*.log')
            seconds = next(float(processor) for name, _, _, processor in
                           re.findall(PHASE, log.read_text(), re.MULTILINE) if name.strip() == 'steps')
        return seconds, max(abs(row['force']) for row in history(folder))


def main():
    """Print a row for each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('old', help='path of the older implam')
    parser.add_argument('--only', nargs='+', choices=CASES, default=list(CASES))
    parser.add_argument('--input', type=pathlib.Path, default=INPUT,
                        help='folder of the decks, such as that of the older version where later decks have later keys')
    parser.add_argument('--until', type=float, help='end of the impacts by central differences, s; default: their own')
    parser.add_argument('--repeat', type=int, default=3, help='runs of each; the median of the ratios is printed')
    arguments = parser.parse_args()
    programs = [os.path.abspath(arguments.old), os.path.abspath(arguments.program)]
    print('| case | older, s | this, s | this over older | limit | change of the peak force, % |')
    print('|---|---|---|---|---|---|')
    for name in arguments.only:
        deck, steps_alone, limit = CASES[name]
        text = deck(arguments.input)
        if arguments.until and "'central_difference'" in text:
            text = change_deck(text, [f'time%end={arguments.until}'])
        pairs = [[measure(program, text, steps_alone) for program in programs] for _ in range(arguments.repeat)]
        old, new = (statistics.median(pair[i][0] for pair in pairs) for i in (0, 1))
        figure = f'{statistics.median(pair[1][0]/pair[0][0] for pair in pairs):.2f}'
        bound = f'{limit:g}'
        if name == 'sun_chen':
            figure, bound = f'{new - old:+.2f} s', f'+{limit:g} s'
        (_, before), (_, after) = pairs[-1]
        change = f'{100*abs(after - before)/before:.2g}' if before > 0 else '-'
        print(f'| {name} | {old:.2f} | {new:.2f} | {figure} | {bound} | {change} |', flush=True)


if __name__ == '__main__':
    main()
