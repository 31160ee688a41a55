"""A model with failing plies and interfaces by central differences, with extreme values of its keys."""

import math
import re

from explicit_runs import INPUT, Run, explicit, row, steps_of  # first: sets the path
from solver_runs import change_deck

# Keys changed in the small model of failing plies and interfaces; a key without a value is removed.
EXTREMES = {
    'as it is': [],
    'plies of .02 mm beside a core of 10 mm': ['laminate%angles=0, 90, 0, 90, 0',
                                               'laminate%thicknesses=0.02e-3, 0.02e-3, 10e-3, 0.02e-3, 0.02e-3'],
    'moduli 1e4 apart': ['material%E1=7.7e12', 'material%E2=7.7e8', 'material%G12=4.8e8', 'material%G23=3.8e8'],
    'impactor of 1 g': ['impactor%mass=1e-3'],
    'impactor of 1 t': ['impactor%mass=1e3', 'impactor%velocity=1'],
    '1 mm/s': ['impactor%velocity=1e-3'],
    '100 m/s': ['impactor%velocity=100'],
    'toughness of 1 J/m2': ['delamination%G_c=1'],
    'toughness of 1e5 J/m2': ['delamination%G_c=1e5'],
    'plies with a toughness of 1 J/m2': [f'material%{key}=1' for key in ('G_ft', 'G_fc', 'G_mt', 'G_mc')],
    'plies with a toughness of 1e5 J/m2': [f'material%{key}=1e5' for key in ('G_ft', 'G_fc', 'G_mt', 'G_mc')],
    'friction of 10': ['delamination%friction=10'],
    'no friction': ['delamination%friction=0'],
    # Elements of 3.16 mm by .158 mm everywhere.
    'cells 20 times longer than wide': ['plate%length=37.92e-3, 9.48e-3', 'mesh%elements=12, 60', 'mesh%grading=1',
                                        'mesh%cell=', 'mesh%core=', 'mesh%patch=6.32e-3', 'delamination%starter=',
                                        'delamination%zone=18.96e-3, 7.9e-3', 'time%end=150e-6'],
    'steps of a thousandth of the stable one': ['time%step_factor=1e-3', 'time%end=5e-6'],
}


def extremes(program, options):
    """A model of failing plies and interfaces, at extremes of its keys."""
    text = (INPUT/'small/breaking_rounds.nml').read_text(encoding='utf-8')
    for name, settings in EXTREMES.items():
        if options.only and not any(word in name for word in options.only):
            continue
        deck = re.sub(r'\s\w+=(?=\s)', '', change_deck(explicit(text), settings))
        steps, _ = steps_of(program, deck)
        if steps is not None and steps > options.max_steps:
            row(name, f'{steps:.3g} steps foreseen, not run')
            continue
        run = Run(program, deck)
        if run.wrong():
            row(name, run.wrong(), '1 %', False)
            continue
        smallest, largest, contact = run.ledger()
        finite = all(map(math.isfinite, (value for entry in run.rows for value in entry.values())))
        warnings = run.said.count('warning')
        row(name, f'{run.rows[-1]["step"]:.0f} steps ({steps or 0:.0f} foreseen), '
                  f'peak {run.summary["peak_force"]:.0f} N, '
            f'{run.rows[-1]["fibre_failures"]:.0f} fibre failures, ledger {100*smallest:.4f} to {100*largest:+.4f} %, '
            f'contact {100*contact:.2f} %, {warnings} warnings, {run.seconds:.0f} s', '1 %',
            finite and smallest > -.01 and largest < .01)
