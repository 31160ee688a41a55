#!/usr/bin/env python3
"""Adaptive steps against fixed ones at equal error of the force history: numbers of solves and factorizations."""
import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile

import numpy as np

from elastic_models import ENVIRONMENT, deck_of, random_models

INPUT = pathlib.Path(__file__).resolve().parents[2] / 'input'
# Time of the end of the run over that of the last contact, so that the run includes the rebound.
BEYOND = 2.4


def with_keys(text, group, **keys):
    """A deck with changed keys of a group."""
    for key, value in keys.items():
        text = re.sub(rf'(?m)(^&{group}\b[^/]*?)\s+{key}=[^/=]*?(?=\s+\w+=|\s*/)', r'\1', text)
        text = re.sub(rf'(?m)^&{group}\b', f'&{group} {key}={value}', text)
    return text


def random_decks(program, numbers):
    """Random elastic models with the mesh that the manual recommends, up to 2.4 times the end of the contact."""
    models = random_models(max(numbers), 1)
    for number in numbers:
        model = models[number - 1]
        said = subprocess.run([program, 'check', '/dev/stdin'], env=ENVIRONMENT, capture_output=True, text=True,
                              input=deck_of(model, case="accuracy='draft'"), check=False).stdout
        last = float(re.search(r'end of the last contact +(\S+)', said)[1])
        tau = model.contact_time()
        mesh = f'&mesh elements=12, 12 patch={min(model.thickness*1.5, min(model.length)/8):.4g} /'
        yield model.name, deck_of(model, mesh=mesh, impactor="integrator='trapezoidal'",
                                  time=f'&time end={BEYOND*last:.4g} step={tau/4:.4g} /'), tau/4


def decks(program, numbers):
    """Name, deck and a coarse step of each model."""
    for name, kinematics in (('sun_chen_elastic', 'linear'), ('sun_chen_tan_sun', 'linear'),
                             ('sun_chen_tan_sun', 'von_karman')):
        text = with_keys((INPUT / 'verify' / (name + '.nml')).read_text(), 'mesh', elements='12,12')
        text = with_keys(text, 'case', kinematics=f"'{kinematics}'")
        yield name + '_' + kinematics, with_keys(text, 'time', end='1000e-6'), 8e-6
    yield 'karas', (INPUT / 'verify' / 'karas.nml').read_text(), 10e-6
    yield from random_decks(program, numbers)


class Run:
    """Force history, solves and factorizations of a run."""

    def __init__(self, program, text):
        with tempfile.TemporaryDirectory() as folder:
            deck = pathlib.Path(folder, 'model.nml')
            deck.write_text(text)
            done = subprocess.run([program, deck, '--output', folder], env=ENVIRONMENT, capture_output=True, text=True,
                                  check=False)
            if done.returncode:
                raise SystemExit(done.stdout + done.stderr)
            summary = next(pathlib.Path(folder).glob('*_summary.json'))
            costs = json.loads(summary.read_text())
            rows = np.genfromtxt(next(pathlib.Path(folder).glob('*_history.csv')), delimiter=',', names=True,
                                 comments='#')
            log = next(pathlib.Path(folder).glob('*.log')).read_text()
        self.time, self.force = np.append(0, rows['time']), np.append(0, rows['force'])
        self.deflection = np.append(0, rows['deflection'])
        self.steps = costs['accepted_steps']
        self.solves, self.factors = costs['costs']['solves'], costs['costs']['refactorisations']
        self.rejected = costs['costs']['rejected']
        self.log = log

    def error(self, finest):
        """Relative error of the force history (L2)."""
        mine = np.interp(finest.time, self.time, self.force)
        return math.sqrt(np.sum((mine - finest.force)**2)/np.sum(finest.force**2))

    def deflection_error(self, finest):
        """Relative error of the deflection history (L2)."""
        mine = np.interp(finest.time, self.time, self.deflection)
        return math.sqrt(np.sum((mine - finest.deflection)**2)/np.sum(finest.deflection**2))


def cost_at(error, runs, price):
    """Solves and factorizations for a given error, by linear interpolation of logarithms between runs; None: out of
    range."""
    points = sorted((run_error, run.solves + price*run.factors) for run_error, run in runs)
    errors = [point[0] for point in points]
    if not min(errors) <= error <= max(errors):
        return None
    return math.exp(np.interp(math.log(error), np.log(errors), np.log([point[1] for point in points])))


def main():
    """Run all models."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('--price', type=float, default=30, help='a factorization over a solve')
    parser.add_argument('--errors', type=float, nargs='+', default=(2, 1), help='of the force history, %%')
    parser.add_argument('--random', type=int, nargs='*', default=(1, 2, 3, 39, 11, 24), help='random elastic models')
    parser.add_argument('--tolerances', type=float, nargs='+', default=(1e-2, 3e-3, 1e-3, 3e-4))
    parser.add_argument('--only', help='models whose names begin with this')
    parser.add_argument('--verbose', action='store_true')
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    won = {error: [] for error in options.errors}
    for name, text, coarse in decks(program, options.random):
        if options.only and not name.startswith(options.only):
            continue
        finest = Run(program, with_keys(text, 'time', step=coarse/32))
        fixed = [(run.error(finest), run) for run in
                 (Run(program, with_keys(text, 'time', step=f'{coarse/ratio:.6g}')) for ratio in (1, 2, 4, 8))]
        own = [(run.error(finest), run) for run in
               (Run(program, with_keys(text, 'time', step=f'{coarse:.6g}') + f'\n&adapt tolerance={tolerance} /\n')
                for tolerance in options.tolerances)]
        line = f'{name:28s}'
        for error in options.errors:
            costs = [cost_at(error/100, runs, options.price) for runs in (fixed, own)]
            if None in costs:
                line += f'  {error:g} %: -              '
                continue
            won[error].append(costs[1]/costs[0])
            line += f'  {error:g} %: {costs[0]:6.0f} {costs[1]:6.0f} {costs[1]/costs[0]:5.2f}'
        print(line, flush=True)
        if options.verbose:
            for kind, runs in (('fixed', fixed), ('own', own)):
                print('   ', kind, ', '.join(f'{100*error:.2f} ({100*run.deflection_error(finest):.2f}) % {run.solves} '
                                             f'solves {run.factors} factors {run.rejected} rejected'
                                             for error, run in runs), flush=True)
    for error, ratios in won.items():
        print(f'{error:g} %: adaptive steps are cheaper on {sum(ratio < 1 for ratio in ratios)} of {len(ratios)}, '
              f'median ratio {np.median(ratios) if ratios else math.nan:.2f}')


if __name__ == '__main__':
    main()
