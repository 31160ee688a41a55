#!/usr/bin/env python3
"""Effect of mesh, step, damping, numerical keys and material data on input/peanut.nml: one row of a table each.

These runs have implicit steps of 16 us; `integrators` compares them with central differences.
"""

import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT/'tests/regress'))
from solver_runs import change_deck

SIDES = (40, 16)  # mm, core and zone of the deck
# Elements of the deck outside its core, along x and y; a finer mesh has the same number.
OUTSIDE = (6, 7)
MATERIAL = ('E1', 'E2', 'G12', 'G13', 'G23', 'YT', 'S12', 'G_Ic', 'G_IIc')


def meshes(text):
    """Settings of each mesh: cells from 1.6 to .4 mm on the same patch, core and zone."""
    del text
    for cell in (1.6, 1.2, 0.8, 0.6, 0.48, 0.4):
        counts = [round(side/2/cell) + rest for side, rest in zip(SIDES, OUTSIDE, strict=True)]
        yield f'cells of {cell} mm', [f'mesh%cell={cell}e-3', 'mesh%elements={}, {}'.format(*counts)]


def steps(text):
    """Settings of each step."""
    del text
    for step in (16, 8, 4):
        yield f'steps of {step} us', [f'time%step={step}e-6']


def damping(text):
    """Settings of each step with other spectral radii."""
    del text
    for rho in (0, 0.25, 0.75):
        for step in (16, 8, 4):
            yield f'rho_inf {rho}, steps of {step} us', [f'time%rho_inf={rho}', f'time%step={step}e-6']


def numbers(text):
    """Numerical keys changed by half of their values."""
    yield 'as it is', []
    del text
    yield 'zone 59.2, 24 mm', ['mesh%core=59.2e-3, 24e-3', 'delamination%zone=59.2e-3, 24e-3', 'mesh%elements=43, 22']
    yield 'solver tolerance 1e-7', ['solver%tolerance=1e-7']
    yield 'rho_inf .25', ['time%rho_inf=.25']
    yield 'rho_inf .75', ['time%rho_inf=.75']
    yield 'stiffness of the interface times 1.5', ['delamination%stiffness=1.134e14']
    yield 'patch 3.2 mm (of the model)', ['mesh%patch=3.2e-3']


def materials(text):
    """Each constant of the material 10 % larger."""
    yield 'as it is', []
    for key in MATERIAL:
        group = 'delamination' if key.startswith('G_') else 'material'
        value = float(re.search(rf'\b{key}=([\d.e+-]+)', text)[1])
        yield f'{key} +10 %', [f'{group}%{key}={1.1*value:g}']


def integrators(text):
    """Implicit steps and central differences with scaled inertia."""
    del text
    yield 'implicit, 16 us', []
    for scaling in (1, 1.52, 6, 10):
        yield (f'central differences, mass_scaling {scaling}',
               ["time%integrator='central_difference'", f'time%mass_scaling={scaling}'])


STUDIES = {study.__name__: study for study in (integrators, meshes, steps, damping, numbers, materials)}


def run(program, text, name):
    """Run a deck and print its row."""
    with tempfile.TemporaryDirectory() as folder:
        deck = pathlib.Path(folder, 'deck.nml')
        deck.write_text(text, encoding='utf-8')
        process = subprocess.Popen([program, 'run', deck, '--output', folder], stdout=subprocess.DEVNULL,
                                   env=dict(os.environ, OMP_NUM_THREADS='1'))
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            print(f'| {name} | ended with code {process.returncode} |', flush=True)
            return
        summary = json.loads(next(pathlib.Path(folder).glob('*_summary.json')).read_text(encoding='utf-8'))
        with next(pathlib.Path(folder).glob('*_history.csv')).open(encoding='utf-8') as lines:
            last = list(csv.DictReader(line.replace(' ', '') for line in lines))[-1]
    place = summary['interfaces'][0]
    growth = place['first_growth']['force'] if place['first_growth'] else float('nan')
    energy = summary['energy_impact']
    print(f'| {name} | {growth:.0f} | {summary["peak_force"]:.0f} | {1e6*summary["delaminated_area"]:.1f} | '
          f'{1e3*(place["x"][1] - place["x"][0]):.1f} x {1e3*(place["y"][1] - place["y"][0]):.1f} | '
          f'{100*summary["energy_delamination"]/energy:.2f}, {100*summary["energy_ply_damage"]/energy:.2f}, '
          f'{100*summary["energy_algorithmic"]/energy:.2f} | {last["step"]}, {last["refactorisations"]} | '
          f'{usage.ru_utime + usage.ru_stime:.0f} |', flush=True)


def main():
    """Run the requested studies."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program', help='path of implam')
    parser.add_argument('study', nargs='+', choices=sorted(STUDIES))
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    text = (ROOT/'input/peanut.nml').read_text(encoding='utf-8')
    text = text.replace('mass_scaling=6', "step=16e-6  integrator='generalized_alpha'")
    for study in arguments.study:
        print('| set | first growth, N | peak force, N | area, mm^2 | along x across, mm | delamination, plies, '
              'integrators, % of the impact | steps, factorizations | processor, s |\n' + '|---'*8 + '|')
        for name, settings in STUDIES[study](text):
            run(program, change_deck(text, settings), name)


if __name__ == '__main__':
    main()
