#!/usr/bin/env python3
"""The cohesive interface against closed forms and an independent calculation: one row of a table for each run.
Usage: cohesive_study.py IMPLAM STUDY...

thresholds  a clamped isotropic plate with cells of 2, 1 and .5 mm, with and without a starter, strengths of 60 MPa:
            force during growth over the closed form, its scatter, and the radius along x and a diagonal
steps       the same with starter, steps of 20, 10 and 5 us
crossply    the force when the area of reference/crossply_cohesive_2mm.nml passes a value, cells of 2 and 1 mm
impact      input/crossply_threshold.nml, no starter: cells of 2.5 and 1.25 mm, steps of 20 and 10 us, other strengths
strips      pure end moments on strips of two arms, shear and opening, fine and coarse cells: moment over the exact one

Fields are read with h5py."""

import csv
import itertools
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT/'tests/regress'))
from solver_runs import change_deck

THRESHOLD = ROOT/'input/verify/cohesive_threshold.nml'
CROSSPLY = ROOT/'input/reference/crossply_cohesive_2mm.nml'
CLOSED_FORM = math.sqrt(8*math.pi**2*50e9*2e-3**3*800/(9*(1 - 0.3**2)))
# Force (N) at given dissipated areas (mm^2), from an independent calculation.
FORCES = {4: 1157, 20: 1279, 50: 1237, 100: 1217, 200: 1211, 300: 1198, 400: 1186, 600: 1165, 800: 1159}


def run(program, text, folder, *options):
    """Run a deck; rows of its history, and processor seconds."""
    deck = pathlib.Path(folder, 'deck.nml')
    deck.write_text(text, encoding='utf-8')
    process = subprocess.Popen([program, 'run', deck, '--output', folder, *options], stdout=subprocess.DEVNULL,
                               env=dict(os.environ, OMP_NUM_THREADS='1'))
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f'A run ended with {process.returncode}.')
    with next(pathlib.Path(folder).glob('*_history.csv')).open(encoding='utf-8') as lines:
        rows = [{name.strip(): float(value) for name, value in row.items()} for row in csv.DictReader(lines)]
    return rows, usage.ru_utime + usage.ru_stime


def radii(folder):
    """Last failed and next node (mm) along x and along the diagonal."""
    import h5py
    with h5py.File(next(pathlib.Path(folder).glob('*.h5'))) as file:
        last = file['times'][max(file['times'])]
        coordinates = file['meshes'][max(file['meshes'])]['coordinates'][()]
        nodes = list(zip(coordinates, last['points/damage_above'][()], strict=True))
    found = []
    for along in (lambda x, y: abs(y) < 1e-9, lambda x, y: abs(x - y) < 1e-9):
        line = sorted({(round(math.hypot(x, y), 9), value) for (x, y, _), value in nodes
                       if min(x, y) >= -1e-9 and along(x, y)})
        beyond = {place: max(value for near, value in line if near == place) for place, _ in line}
        failed = [place for place, value in beyond.items() if value > 0.99]
        following = [place for place in beyond if place > max(failed)]
        found.append((1e3*max(failed), 1e3*min(following)))
    return found


def thresholds(program):
    """Three meshes with and without starter."""
    print('| cells, mm | starter, mm | peak force, N | mean while growing, N | over closed form | farthest from mean '
          '| failed to, next node, mm: along x, diagonal | steps, iterations | processor, s |\n' + '|---'*9 + '|')
    for cell, elements in ((2, 15), (1, 26), (0.5, 50)):
        for starter in (12e-3 if cell == 2 else 10e-3, None):
            settings = [f'mesh%elements={elements}, {elements}', f'mesh%cell={cell}e-3']
            text = change_deck(THRESHOLD.read_text(encoding='utf-8'), settings)
            text = text.replace('starter=0.012', f'starter={starter}' if starter else '')
            with tempfile.TemporaryDirectory() as folder:
                rows, seconds = run(program, text, folder)
                along, across = radii(folder)
            peak = max(row['force'] for row in rows)
            # After the first decrease of the force, while the front is two cells from the border of the zone.
            fall = next(i for i in range(1, len(rows)) if rows[i]['force'] < rows[i - 1]['force']
                        and rows[i]['delaminated_area'] > 1e-6)
            growing = [row['force'] for row, before in zip(rows[fall:], rows[fall - 1:], strict=False)
                       if row['delaminated_area'] < math.pi*(0.02 - 2e-3*cell)**2
                       and row['delaminated_area'] > before['delaminated_area'] + 1e-6]
            mean = sum(growing)/len(growing)
            scatter = max(abs(force/mean - 1) for force in growing)
            name = f'{1e3*starter:g}' if starter else 'none'
            print(f'| {cell} | {name} | {peak:.0f} | {mean:.1f} | {mean/CLOSED_FORM:.4f} | {100*scatter:.2f} % | '
                  f'{along[0]:.2f} to {along[1]:.2f}, {across[0]:.2f} to {across[1]:.2f} | '
                  f'{rows[-1]["step"]:.0f}, {rows[-1]["total_iterations"]:.0f} | {seconds:.0f} |', flush=True)


def steps(program):
    """Three steps."""
    print('| step, us | area, mm^2 | radius of a circle as large, mm | integrators over the impact | processor, s |\n'
          + '|---'*5 + '|')
    for step in (20, 10, 5):
        with tempfile.TemporaryDirectory() as folder:
            rows, seconds = run(program, change_deck(THRESHOLD.read_text(encoding='utf-8'),
                                                     [f'time%step={step}e-6']), folder)
        area = rows[-1]['delaminated_area']
        smallest, limit = (bound(row['energy_algorithmic'] for row in rows)/(10*0.6313**2) for bound in (min, max))
        print(f'| {step} | {1e6*area:.1f} | {1e3*math.sqrt(area/math.pi):.2f} | {smallest:.1e} to {limit:.1e} | '
              f'{seconds:.0f} |', flush=True)


def force_at(area, rows):
    """Force at a given area, by linear interpolation between rows."""
    for row, before in zip(rows[1:], rows, strict=False):
        if row['delaminated_area'] >= area > before['delaminated_area']:
            part = (area - before['delaminated_area'])/(row['delaminated_area'] - before['delaminated_area'])
            return before['force'] + part*(row['force'] - before['force'])
    return float('nan')


def crossply_row(program, name, settings):
    """Run the cross-ply and print its row."""
    with tempfile.TemporaryDirectory() as folder:
        rows, seconds = run(program, change_deck(CROSSPLY.read_text(encoding='utf-8'), settings), folder)
    forces = [force_at(1e-6*area, rows) for area in FORCES]
    worst = max(abs(force/expected - 1) for force, expected in zip(forces, FORCES.values(), strict=True))
    print(f'| {name} | ' + ' | '.join(f'{force:.0f}' for force in forces) + f' | {100*worst:.1f} % | '
          f'{rows[-1]["step"]:.0f}, {rows[-1]["total_iterations"]:.0f} | {seconds:.0f} |', flush=True)


def crossply_head():
    """Print the head of the table of the cross-ply."""
    print('| force in N at mm^2 | ' + ' | '.join(map(str, FORCES)) + ' | worst | steps, iterations | processor, s |\n'
          + '|---'*(len(FORCES) + 4) + '|')
    print('| independent | ' + ' | '.join(map(str, FORCES.values())) + ' | | | |', flush=True)


def crossply(program):
    """Two meshes."""
    crossply_head()
    crossply_row(program, 'cells of 2 mm', [])
    crossply_row(program, 'cells of 1 mm', ['mesh%elements=50, 50'])


def impact(program):
    """A drop weight: peak force, force during growth, area."""
    text = (ROOT/'input/crossply_threshold.nml').read_text(encoding='utf-8')
    print('| set | peak force, N | mean while growing, N | area, mm^2 | integrators over the impact | processor, s |\n'
          + '|---'*6 + '|')
    for name, settings in (('cells of 2.5 mm', ['mesh%cell=2.5e-3', 'mesh%elements=18, 18']), ('as it is', []),
                           ('steps of 10 us', ['time%step=10e-6']), ('strengths of 40 MPa', [
                               'material%S12=40e6', 'material%YT=40e6'])):
        with tempfile.TemporaryDirectory() as folder:
            rows, seconds = run(program, change_deck(text, settings), folder)
        steps = [(later['force'], later['delaminated_area'] - row['delaminated_area'])
                 for row, later in itertools.pairwise(rows) if row['delaminated_area'] > 100e-6]
        mean = sum(force*area for force, area in steps)/sum(area for _, area in steps)
        print(f'| {name} | {max(row["force"] for row in rows):.0f} | {mean:.0f} | '
              f'{1e6*rows[-1]["delaminated_area"]:.0f} | {rows[-1]["energy_algorithmic"]/(2*1.4**2):.1e} | '
              f'{seconds:.0f} |', flush=True)


def strips(program):
    """Two modes, two sizes of cells."""
    print('| moments, strength, cells | mean over exact | largest |\n|---|---|---|')
    bending = 139e9*0.667e-3**3/12
    for kind, exact, cases in (('shear', 20e-3*math.sqrt(16/3*800*bending)/2, ((80e6, 60), (30e6, 30))),
                               ('opening', 20e-3*math.sqrt(250*bending), ((10e6, 60),))):
        text = (ROOT/f'input/verify/moment_{kind}.nml').read_text(encoding='utf-8')
        for strength, elements in cases:
            with tempfile.TemporaryDirectory() as folder:
                rows, _ = run(program, change_deck(text, [f'mesh%elements={elements}, 2',
                                                          f'delamination%strength_{kind}={strength}']), folder)
            grown = [abs(row['line_force_1'])/exact for row in rows
                     if row['energy_delamination'] > 0.2*rows[-1]['energy_delamination']]
            print(f'| {kind}, {strength/1e6:g} MPa, {60/elements:g} mm | {sum(grown)/len(grown):.4f} | '
                  f'{max(grown):.4f} |', flush=True)


STUDIES = {study.__name__: study for study in (thresholds, steps, crossply, impact, strips)}


def main(program, *studies):
    """Run the requested studies."""
    unknown = [study for study in studies if study not in STUDIES]
    if unknown or not studies:
        raise SystemExit(f'Studies: {", ".join(STUDIES)}.')
    for study in studies:
        STUDIES[study](os.path.abspath(program))


if __name__ == '__main__':
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
