#!/usr/bin/env python3
"""Least processor time for an error of the force history: Sun and Chen's plate against the semi-analytic response."""
import argparse

from elastic_models import Run, deck_of
from modal_impact import Model, response

END, PATCH = 1e-3, 5e-3
SUN_CHEN = Model((0.2, 0.2), [0, 90, 0, 90, 0, 0, 90, 0, 90, 0], 0.269e-3, (120e9, 7.9e9, 5.5e9, 5.5e9, 5.5e9, 0.3),
                 1580, 8.537e-3, 3, 6.35e-3, 8.112e8, law='hertz', name='sun_chen')


def main():
    """Run all meshes and steps and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program')
    parser.add_argument('--errors', type=float, nargs='+', default=(1, 3), help='of the force history, %%')
    parser.add_argument('--elements', type=int, nargs='+', default=(8, 10, 12, 14, 16))
    parser.add_argument('--steps', type=float, nargs='+', default=(8, 6, 5, 4, 3, 2), help='us')
    parser.add_argument('--repeat', type=int, default=5)
    options = parser.parse_args()
    exact = response(SUN_CHEN, PATCH, END)[:2]
    print('elements  step, us  peak, %  history, %  processor, s (least of the runs)')
    found = []
    for elements in options.elements:
        for step in options.steps:
            deck = deck_of(SUN_CHEN, mesh=f'&mesh elements={elements}, {elements} patch={PATCH} grading=1 /',
                           impactor="integrator='trapezoidal'", time=f'&time end={END} step={step}e-6 rho_inf=1 /')
            runs = [Run(options.program, deck, SUN_CHEN.name) for _ in range(options.repeat)]
            if runs[0].code:
                raise SystemExit(runs[0].said)
            peak, history = runs[0].errors(*exact)
            found.append((100*history, min(run.seconds for run in runs), elements, step))
            print(f'{elements:5d}x{elements:<5d} {step:5g}  {100*peak:+7.2f}  {100*history:9.2f}  {found[-1][1]:9.3f}',
                  flush=True)
    for error in options.errors:
        good = [row for row in found if row[0] <= error]
        if good:
            _, seconds, elements, step = min(good, key=lambda row: row[1])
            print(f'at most {error:g} %: {seconds:.3f} s, {elements} x {elements} elements and steps of {step:g} us')


if __name__ == '__main__':
    main()
