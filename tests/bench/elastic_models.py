#!/usr/bin/env python3
"""Semi-analytic responses: peak force and history on meshes and steps that `&case accuracy` chooses, within one and
three times the requested error. See README.md."""
import argparse
import csv
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import tempfile

import numpy as np

from modal_impact import Model, response

# One thread, so that processor time is comparable; Open MPI refuses root unless asked twice.
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS='1', OPENBLAS_NUM_THREADS='1',
                   OMPI_ALLOW_RUN_AS_ROOT='1', OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1')

DECK = """&case name='{name}' kinematics='linear' {case} /
&plate length={length[0]:.6g}, {length[1]:.6g} edges='simple' symmetry='quarter' /
{mesh}
&material name='ply' density={density} E1={moduli[0]:.6g} E2={moduli[1]:.6g} G12={moduli[2]:.6g} G13={moduli[3]:.6g}
          G23={moduli[4]:.6g} nu12={moduli[5]} /
&laminate materials='ply' angles={angles} thicknesses={ply:.6g} shear_correction='5/6' /
&impactor mass={mass:.6g} velocity={velocity:.6g} radius={radius:.6g} {impactor} /
&indentation {law} k={k:.6g} /
{time}
{more}
"""


def limit_time(seconds):
    """End a run after some processor seconds."""
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


def random_models(count, seed):
    """Cross-ply plates and balls over the range of low-velocity impact, all laws."""
    random = np.random.default_rng(seed)

    def spread(low, high):
        return float(f'{math.exp(random.uniform(math.log(low), math.log(high))):.4g}')

    models = []
    while len(models) < count:
        plies = int(random.integers(1, 25))
        half = [int(90*random.integers(0, 2)) for _ in range((plies + 1)//2)]
        angles = half + half[:plies//2][::-1]
        ply = spread(0.1e-3, 0.4e-3)
        longer = spread(30e-3, 1)
        length = (longer, float(f'{longer*random.uniform(0.5, 1):.4g}'))
        moduli = (spread(40e9, 200e9), spread(6e9, 12e9), spread(3e9, 7e9), spread(3e9, 7e9), spread(2.5e9, 5e9), 0.3)
        radius = spread(3e-3, 30e-3)
        model = Model(length, angles, ply, moduli, spread(1400, 2000), spread(1e-4, 10), spread(0.3, 30), radius,
                      float(f'{4/3*math.sqrt(radius)*moduli[1]:.5g}'),
                      str(random.choice(['hertz', 'tan_sun', 'yang_sun'])), name=f'model_{len(models) + 1}')
        if 10 < min(length)/model.thickness < 1000:
            models.append(model)
    return models


def deck_of(model, case='', mesh='', impactor='', time='', more=''):
    """The deck of the model."""
    law = ("law='hertz'" if model.law == 'hertz' else
           f"law='tan_sun' dent='{model.law}' q={model.q} alpha_cr={model.alpha_cr} " +
           (f'beta={model.beta}' if model.law == 'tan_sun' else ''))
    fields = {key: getattr(model, key) for key in ('name', 'length', 'moduli', 'density', 'ply', 'mass', 'velocity',
                                                   'radius', 'k')}
    return DECK.format(**fields, angles=','.join(map(str, model.angles)), law=law, case=case, mesh=mesh,
                       impactor=impactor, time=time, more=more)


class Run:
    """One run: exit code, processor time, log, history, and errors against the semi-analytic response."""

    def __init__(self, program, deck, name, seconds=60):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, name + '.nml')
            path.write_text(deck)
            with open(pathlib.Path(folder, 'said'), 'w') as said:
                process = subprocess.Popen([program, path, '--output', folder], stdout=said, stderr=said,
                                           env=ENVIRONMENT, preexec_fn=lambda: limit_time(seconds))
                _, status, usage = os.wait4(process.pid, 0)
            process.returncode = self.code = os.waitstatus_to_exitcode(status)
            self.seconds = usage.ru_utime + usage.ru_stime
            self.said = pathlib.Path(folder, 'said').read_text()
            log = pathlib.Path(folder, name + '.log')
            summary = pathlib.Path(folder, name + '_summary.json')
            self.summary = json.loads(summary.read_text()) if summary.exists() else {}
            self.log = log.read_text() if log.exists() else ''
            if self.code:
                return
            with open(pathlib.Path(folder, name + '_history.csv')) as lines:
                rows = list(csv.DictReader(line for line in lines if not line.startswith('#')))
        self.time = np.array([float(row['time']) for row in rows])
        self.force = np.array([float(row['force']) for row in rows])
        self.steps = int(re.search(r'(\d+) steps?', self.log)[1])
        self.unknowns = int(re.search(r'(\d+) unknowns', self.log)[1])

    def key(self, group, name):
        """Numbers of a key as the log lists it."""
        found = re.search(rf"&{group} {name} = (.*?) \[", self.log)
        return [float(word) for word in re.split('[ ,]+', found[1])]

    def errors(self, times, forces):
        """Relative errors of peak force and of the force history (L2)."""
        mine = np.interp(times, np.append(0, self.time), np.append(0, self.force))
        return self.force.max()/forces.max() - 1, math.sqrt(np.sum((mine - forces)**2)/np.sum(forces**2))


def over_estimates(summary, answered):
    """Errors of peak force, its time, contact duration and the ball's velocity over the run's estimates."""
    times, forces, speeds, _ = answered
    exact = {'peak_force': forces.max(), 'peak_force_at': times[forces.argmax()],
             'contact_duration': np.count_nonzero(forces > 0)*times[1], 'impactor_velocity': speeds[-1]}
    estimate = summary['estimated_errors']
    return [abs(summary[name] - value)/estimate[name] if estimate[name] else math.inf
            for name, value in exact.items()]


def compare(program, model, case, seconds=60):
    """One row of the table: the run with some keys of the case, its errors, and their ratios to its estimates."""
    run = Run(program, deck_of(model, case=case), model.name, seconds)
    if run.code:
        return run, None, None
    tau = model.contact_time()
    end = run.key('time', 'end')[0]
    # A long contact depends on low modes: with twice as many modes peak and history change by less than 0.1 %.
    long = end > 300*tau
    answered = response(model, run.key('mesh', 'patch')[0], end, *((20, 20) if long else (60, 50)))
    return run, run.errors(*answered[:2]), over_estimates(run.summary, answered)


def named_by(said, summary, bound):
    """What warns a user of an error: a warning of the check, or the run's estimate beyond the bound, %."""
    estimate = summary.get('estimated_errors', {}).get('peak_force') or 0
    beyond = summary and 100*estimate > bound*summary['peak_force']
    return [name for name, warns in (('check', ': warning:' in said), ('estimate', beyond)) if warns]


def main():
    """Run the models and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('--accuracy', default="'standard'", help="a name in quotes of the deck, or a number in %%")
    parser.add_argument('--bounds', type=float, nargs=2, default=(1, 3), help='errors of peak and history allowed, %%')
    parser.add_argument('--count', type=int, default=40)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--longest', type=float, default=2000,
                        help='models with contacts of more rise times than this are left out')
    parser.add_argument('--seconds', type=int, default=60, help='processor time after which a run is ended')
    parser.add_argument('--only', type=int, nargs='+', help='numbers of models')
    parser.add_argument('--case', default='', help='more keys of &case')
    parser.add_argument('--at-least', type=int, default=0, help='models within the bounds, or else exit code 1')
    options = parser.parse_args()
    within, held, seconds, answered, printed = 0, 0, [], 0, np.zeros(4, int)
    print('model      peak, %  history, %  elements  steps  in a rise  end/rise  processor, s  over the estimates')
    for number, model in enumerate(random_models(options.count, options.seed), 1):
        if options.only and number not in options.only:
            continue
        tau = model.contact_time()
        said = subprocess.run([options.program, 'check', '/dev/stdin'], env=ENVIRONMENT, capture_output=True, text=True,
                              input=deck_of(model, case=f'accuracy={options.accuracy}'), check=False).stdout
        last = re.search(r'end of the last contact +(\S+)', said)
        if last and float(last[1]) > options.longest*tau:
            print(f'{model.name:9s}  the contact lasts {float(last[1])/tau:.0f} rises', *named_by(said, {}, 0))
            continue
        run, errors, ratios = compare(options.program, model, f'accuracy={options.accuracy} {options.case}',
                                     options.seconds)
        seconds.append(run.seconds)
        answered += 1
        names = named_by(said, run.summary, options.bounds[0])
        held += bool(names)
        if run.code:
            lines = run.said.splitlines() or ['']
            print(f'{model.name:9s}  exit code {run.code}: {lines[-1][:90]}', *names, flush=True)
            continue
        good = abs(errors[0])*100 <= options.bounds[0] and errors[1]*100 <= options.bounds[1]
        within += good
        held += good and not names
        elements = 'x'.join(f'{n:.0f}' for n in run.key('mesh', 'elements'))
        step = run.key('time', 'step')[0]
        print(f'{model.name:9s}  {100*errors[0]:+7.2f}  {100*errors[1]:10.2f}  {elements:>8s}  {run.steps:5d}'
              f'  {tau/step:9.1f}  {run.time[-1]/tau:8.1f}  {run.seconds:12.2f}  '
              f'{" ".join(f"{ratio:5.2f}" for ratio in ratios)}{"" if good else "  misses"}', *names, flush=True)
        printed += np.array(ratios) <= 2
    print(f'{within} of {answered} within {options.bounds[0]:g} % and {options.bounds[1]:g} %; {held} within '
          f'or named; processor time of the median model {np.median(seconds):.2f} s')
    print('within twice the estimate: peak {}, its time {}, time in contact {}, velocity {}'.format(*printed))
    if within < options.at_least:
        raise SystemExit(1)


if __name__ == '__main__':
    main()
