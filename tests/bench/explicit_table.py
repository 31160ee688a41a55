#!/usr/bin/env python3
"""Requirements on central differences as a table: each row has a figure and its bound. See README.md.
Usage: explicit_table.py IMPLAM PART...     (with Python of .venv; PARTs with --list)"""

import argparse
import math
import os
import re
import subprocess

from explicit_runs import ENVIRONMENT, EXPLICIT, INPUT, Run, explicit, panel_text, row, steps_of  # first: sets the path
import breaking_models
import cohesive_study
import damaging_models
import elastic_models
import numpy as np
from explicit_extremes import extremes
from explicit_ranks import messages, ranks
from modal_impact import Model, response
from solver_runs import change_deck

IMPLICIT = "integrator='generalized_alpha'"
MAX_STEPS = 1e6
ROWS_IN_RISE = 20


def elastic(program, options):
    """Histories of elastic impacts against semi-analytic ones, on the meshes of accuracy='reference'."""
    moduli = (120e9, 7.9e9, 5.5e9, 5.5e9, 5.5e9, .3)
    steel = 206.8e9/2.56
    models = [Model((.2, .2), [0, 90, 0, 90, 0, 0, 90, 0, 90, 0], .269e-3, moduli, 1580, 8.537e-3, 3, 6.35e-3, 8.112e8,
                    name='sun_chen'),
              Model((.2, .2), [0], 8e-3, (206.8e9, 206.8e9, steel, steel, steel, .28), 7833, .0328108, 1, .01,
                    1.49595e10, name='karas')]
    models += elastic_models.random_models(options.count, 1)
    if options.only:
        models = [model for model in models if model.name in options.only]
    for scaling, bound in (('mass_scaling=1', .5), ('', 1)):
        held = run_count = 0
        for model in models:
            text = elastic_models.deck_of(model, case="accuracy='reference'", time=f'&time {EXPLICIT} {scaling} /')
            steps, step = steps_of(program, text)
            name = f'{model.name}, {scaling or "default scaling"}'
            if steps is None or steps > options.max_steps:
                row(name, f'{steps or 0:.2g} steps, not run')
                continue
            # Linear interpolation of a half sine is in error by less than .1 % with 20 rows in the rise time.
            every = min(steps*step/2000, model.contact_time()/ROWS_IN_RISE)
            run = elastic_models.Run(program, f'{text}\n&output history_every={every} /', model.name, 7200)
            run_count += 1
            if run.code:
                row(name, f'ends with {run.code}: {(run.said.splitlines() or [""])[-1][:80]}', '', False)
                continue
            end, patch = run.key('time', 'end')[0], run.key('mesh', 'patch')[0]
            fine = (20, 20) if end > 300*model.contact_time() else (60, 50)
            peak, history = (100*error for error in run.errors(*response(model, patch, end, *fine)[:2]))
            scaled = run.key('time', 'mass_scaling')[0]
            held += history <= bound
            row(name, f'history {history:.2f} %, peak {peak:+.2f} %, scaling {scaled:g}, {run.steps} steps, '
                f'{run.unknowns} unknowns, {run.seconds:.1f} s', f'{bound} %', history <= bound)
        row(f'elastic, {scaling or "default scaling"}', f'{held} of {run_count} within', f'{bound} %',
            held == run_count)


def peanut_text(cell):
    """The peanut with cells of some mm; for .6 mm patch and core are multiples of the cell."""
    text = (INPUT/'peanut.nml').read_text(encoding='utf-8').replace('mass_scaling=6', 'step=16e-6')
    text = change_deck(text, ['output%fields_every=4e-3'])
    if cell == .8:
        return text
    return change_deck(text, ['mesh%elements=40, 20', 'mesh%patch=1.2e-3', 'mesh%core=40.8e-3, 15.6e-3',
                              'mesh%cell=0.6e-3', 'delamination%zone=40.8e-3, 15.6e-3'])


def peanut(program, options):
    """First growth, peak and area of the peanut by both integrators."""
    for cell in options.cells or (.8, .6):
        text = peanut_text(cell)
        found = {}
        for way, deck in (('implicit', change_deck(text, [f'time%{IMPLICIT}'])),
                          ('explicit', explicit(text))):
            run = Run(program, deck)
            if run.wrong():
                row(f'peanut {cell} mm, {way}', run.wrong(), '', False)
                return
            growth = run.summary['interfaces'][0]['first_growth']['force']
            found[way] = growth, run.summary['peak_force'], 1e6*run.summary['delaminated_area']
            smallest, largest, contact = run.ledger()
            row(f'peanut {cell} mm, {way}', '{:.0f} N, {:.0f} N, {:.1f} mm2'.format(*found[way]) +
                f', ledger {100*smallest:.4f} to {100*largest:+.4f} %, contact {100*contact:.2f} %, '
                f'{run.seconds:.0f} s',
                '.2 %, +.05 %', way == 'implicit' or (smallest > -2e-3 and largest < 5e-4))
        apart = [100*(b/a - 1) for a, b in zip(found['implicit'], found['explicit'], strict=True)]
        row(f'peanut {cell} mm: first growth, peak, area', '{:+.1f} %, {:+.1f} %, {:+.1f} %'.format(*apart), '2 %',
            max(map(abs, apart)) <= 2)


def thresholds(program, options):
    """Mean force while a delamination grows, against the closed form."""
    for cell, elements in ((2, 15), (1, 26), (.5, 50)):
        if options.cells and cell not in options.cells:
            continue
        settings = [f'mesh%elements={elements}, {elements}', f'mesh%cell={cell}e-3',
                    f'delamination%starter={12e-3 if cell == 2 else 10e-3}']
        text = explicit(change_deck(cohesive_study.THRESHOLD.read_text(encoding='utf-8'), settings))
        run = Run(program, text)
        if run.wrong():
            row(f'threshold {cell} mm', run.wrong(), '', False)
            continue
        # While the area grows from twice the starter's to two cells from the border of the zone.
        start = 2*run.rows[0]['delaminated_area']
        end = math.pi*(.02 - 2e-3*cell)**2
        growing = [(after['force'], after['delaminated_area'] - before['delaminated_area'])
                   for before, after in zip(run.rows, run.rows[1:], strict=False)
                   if start < after['delaminated_area'] < end]
        # Mean over time, as a testing machine would measure it, and over the area.
        mean = np.mean([force for force, _ in growing])
        by_area = sum(force*area for force, area in growing)/sum(area for _, area in growing)
        ratio = mean/cohesive_study.CLOSED_FORM
        smallest, largest, contact = run.ledger()
        row(f'threshold {cell} mm', f'{mean:.0f} N over time, {by_area:.0f} N over area, peak '
            f'{run.summary["peak_force"]:.0f} N, ledger {100*smallest:.4f} to {100*largest:+.4f} %, contact '
            f'{100*contact:.2f} %, {run.seconds:.0f} s', '1756 N, 3 %', abs(ratio - 1) <= .03)


def damaging(program, options):
    """Random models whose interfaces delaminate."""
    ended = quick = recorded = worked = closed = 0
    for seed in range(options.first, options.first + options.count):
        model = damaging_models.model(seed)
        run = Run(program, explicit(damaging_models.deck(model), options.time), seconds=600)
        if run.wrong():
            row(f'damaging {seed}', run.wrong(), '', False)
            continue
        ended += 1
        fast = run.seconds < 20
        last = run.rows[-1]
        area = last['delaminated_area'] - (run.rows[0]['delaminated_area'] if model['starter'] else 0)
        cost, energy = model['G_c']*area, last['energy_delamination']
        right = abs(energy - cost) <= 1e-6*max(cost, 1e-12)
        # Work of the tractions beyond the energy stored and recorded as fracture, friction or contact loss.
        beyond = last['energy_algorithmic']/energy if energy > 0 else 0
        smallest, largest, contact = run.ledger()
        good = smallest > -2e-3 and largest < 5e-4
        quick += fast
        recorded += right
        worked += abs(beyond) <= .01
        closed += good
        row(f'damaging {seed}', f'{1e6*area:.1f} mm2, recorded over G_c area - 1 '
            f'{energy/cost - 1 if cost > 0 else 0:.1e}, algorithmic {100*beyond:+.2f} % of fracture, ledger '
            f'{100*smallest:.4f} to {100*largest:+.4f} %, contact {100*contact:.2f} %, {last["step"]:.0f} steps, '
            f'{run.seconds:.1f} s', '', right and good and fast and abs(beyond) <= .01)
    row('damaging: end, under 20 s, G_c area to 1e-6, tractions to 1 %, ledger',
        f'{ended}, {quick}, {recorded}, {worked}, {closed}', f'{options.count} each',
        min(ended, quick, recorded, worked, closed) == options.count)


def breaking(program, options):
    """Random models whose plies fail."""
    held, worst = 0, [0.0, 0.0, 0.0]
    for seed in range(options.count):
        run = Run(program, explicit(breaking_models.deck(seed, 1), options.time), seconds=600)
        if run.wrong():
            row(f'breaking {seed}', run.wrong(), '', False)
            continue
        smallest, largest, contact = run.ledger()
        good = smallest > -2e-3 and largest < 5e-4 and contact < .02
        held += good
        worst = [min(worst[0], smallest), max(worst[1], largest), max(worst[2], contact)]
        row(f'breaking {seed}', f'ledger {100*smallest:.4f} to {100*largest:+.4f} %, contact {100*contact:.2f} %, '
            f'{run.rows[-1]["fibre_failures"]:.0f} fibre failures, {run.rows[-1]["step"]:.0f} steps, '
            f'{run.seconds:.1f} s', '-.2 to +.05 %, 2 %', good)
    row('breaking models', f'{held} of {options.count}; worst ' +
        '{:.3f} %, {:+.4f} %, {:.2f} %'.format(*(100*value for value in worst)), '', held == options.count)


def remainder(run):
    """Root mean square of the energy error over the impact energy."""
    impact = run.summary['energy_impact']
    return math.sqrt(np.mean([(entry['energy_error']/impact)**2 for entry in run.rows]))


def halves(program, options):
    """Ratio of the energy error with half the step length to that with the full one."""
    texts = {'karas': (INPUT/'verify/karas.nml').read_text(encoding='utf-8'),
             'sun_chen_elastic': (INPUT/'verify/sun_chen_elastic.nml').read_text(encoding='utf-8'),
             'cohesive': (INPUT/'small/cohesive.nml').read_text(encoding='utf-8')}
    if not options.quick:
        texts['peanut'] = peanut_text(.8)
    for name, text in texts.items():
        whole, half = (remainder(Run(program, explicit(text, f'step_factor={part}'))) for part in (.9, .45))
        row(f'{name}: remainder with half the step', f'{half:.1e} of {whole:.1e}', 'half', half <= .55*whole)
    found = []
    for seed in range(10):
        runs = [Run(program, explicit(breaking_models.deck(seed, 1), f'step_factor={part}')) for part in (.9, .45)]
        if not any(run.wrong() for run in runs):
            found.append([remainder(run) for run in runs])
    whole, half = np.mean(found, axis=0)
    row(f'{len(found)} breaking models: remainder with half the step', f'{half:.1e} of {whole:.1e}', 'no larger',
        half <= 1.05*whole)


def panels(program, options):
    """Cost of the panels: estimated, and measured with --run. The limits are fractions of the 3060 s of implicit
    steps."""
    decks = [(f'25 J, {cell} mm', panel_text(cell), limit) for cell, limit in ((3, 153), (1.5, 765))]
    decks.append(('6.5 J, as it is', (INPUT/'experiments/t700_m21_6.5J.nml').read_text(encoding='utf-8'), 765))
    for name, deck, limit in decks:
        said = subprocess.run([program, 'check', '/dev/stdin'], env=ENVIRONMENT, capture_output=True, text=True,
                              input=deck, check=False).stdout
        printed = [line for line in said.splitlines() if line.startswith('About')]
        row(name, ' '.join(printed))
        if not options.run:
            continue
        run = Run(program, deck)
        if run.wrong():
            row(name, run.wrong(), '', False)
            continue
        smallest, largest, contact = run.ledger()
        row(name, f'peak {run.summary["peak_force"]:.0f} N, {1e3*run.summary["largest_deflection"]:.2f} mm, '
            f'{1e6*run.summary["delaminated_area"]:.0f} mm2, '
            f'ledger {100*smallest:.4f} to {100*largest:+.4f} %, contact '
            f'{100*contact:.2f} %, {run.seconds:.0f} s', f'{limit} s, +.05 %, 1.5 %',
            run.seconds <= limit and smallest > -2e-3 and largest < 5e-4 and contact < .015)


def costs(program, options):
    """Cost of a step against the number of elements: from two runs, one with three times the steps of the other."""
    text = cohesive_study.THRESHOLD.read_text(encoding='utf-8')
    for elements in (20, 40, 80, 160, 190)[:3 if options.quick else 5]:
        smallest = max(20, 1_000_000//elements**2)
        settings = [f'mesh%elements={elements}, {elements}', f'mesh%cell={.03/elements}']
        deck = explicit(change_deck(text, settings))
        step = 6.5e-3/steps_of(program, deck)[0]
        deck = change_deck(deck, ['output%history_every=1', 'output%fields_every=1'])
        runs = [Run(program, re.sub(r'\bend=\S+', f'end={steps*step}', deck)) for steps in (smallest, 3*smallest)]
        if any(run.wrong() for run in runs):
            row(f'{elements}x{elements}', runs[0].wrong() or runs[1].wrong(), '', False)
            continue
        unknowns, count = (int(re.search(rf'(\d+) {what}', runs[0].log)[1]) for what in ('unknowns?', 'elements?'))
        steps = runs[1].rows[-1]['step'] - runs[0].rows[-1]['step']
        row(f'{unknowns} unknowns, {count} elements of layers',
            f'{1e6*(runs[1].seconds - runs[0].seconds)/steps/count:.3f} us an element and step, {steps:.0f} steps')


def scaling(program, options):
    """Effect of the factor of in-plane and rotary inertia on elastic impacts and impacts with ply failure."""
    decks = {name: (INPUT/path).read_text(encoding='utf-8') for name, path in (
        ('Sun-Chen', 'verify/sun_chen_elastic.nml'), ('Karas', 'verify/karas.nml'), ('peanut', 'peanut.nml'))}
    if options.run:
        decks['25 J panel, 3 mm'] = panel_text(3)
    for name, deck in decks.items():
        text = re.sub(r'mass_scaling=\S+', '', deck)
        for factor in (1, 3, 6, 10, 20, 40):
            run = Run(program, explicit(text, f'mass_scaling={factor}'))
            if run.wrong():
                row(f'{name}, factor {factor}', run.wrong(), '', False)
                continue
            last = run.rows[-1]
            left = last['energy_impactor'] + last['energy_indentation']
            smallest, largest, _ = run.ledger()
            row(f'{name}, factor {factor}', f'peak {run.summary["peak_force"]:.1f} N, area '
                f'{1e6*(run.summary.get("delaminated_area") or 0):.1f} mm2, absorbed '
                f'{run.summary["energy_impact"] - left:.4g} J, ledger {100*smallest:.4f} to {100*largest:+.4f} %, '
                f'{last["step"]:.0f} steps, {run.seconds:.1f} s')


PARTS = {part.__name__: part for part in (elastic, peanut, thresholds, damaging, breaking, halves, ranks, panels,
                                          costs, scaling, messages, extremes)}


def main():
    """Run the requested parts."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog='\n'.join(f'{name:12}{part.__doc__}' for name, part in PARTS.items()))
    parser.add_argument('program')
    parser.add_argument('parts', nargs='*', choices=[*PARTS, []], metavar='PART', help='all if none is given')
    parser.add_argument('--count', type=int, default=20, help='random models of a part')
    parser.add_argument('--first', type=int, default=1, help='first random model of damaging')
    parser.add_argument('--time', default='', help='keys of &time of damaging and breaking, as step_factor=0.45')
    parser.add_argument('--max-steps', type=float, default=MAX_STEPS, help='elastic runs of more steps are left out')
    parser.add_argument('--only', nargs='+', help='elastic models by name, as model_3 or karas; extremes by words')
    parser.add_argument('--cells', type=float, nargs='+', help='of peanut and thresholds, mm')
    parser.add_argument('--quick', action='store_true',
                        help='leave out the peanut of halves, the last of costs and most of ranks')
    parser.add_argument('--run', action='store_true', help='run the panels, in scaling too')
    options = parser.parse_args()
    print('| what | figure | bound | |\n|---|---|---|---|')
    for part in options.parts or PARTS:
        PARTS[part](os.path.abspath(options.program), options)


if __name__ == '__main__':
    main()
