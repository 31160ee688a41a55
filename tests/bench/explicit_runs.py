"""Runs by central differences, and their rows in the table of explicit_table.py."""

import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
INPUT = HERE.parents[1]/'input'
sys.path[:0] = [str(HERE), str(HERE.parent/'studies'), str(HERE.parent/'regress')]
import elastic_models
from solver_runs import change_deck

EXPLICIT = "integrator='central_difference'"
ENVIRONMENT = dict(elastic_models.ENVIRONMENT, OMPI_MCA_mpi_yield_when_idle='1')
MPIRUN = ('mpirun', '--allow-run-as-root', '--oversubscribe', '-n')


class Run:
    """A run: exit code, processor time, rows and summary."""

    def __init__(self, program, text, launcher=(), seconds=3600):
        with tempfile.TemporaryDirectory() as folder:
            deck = pathlib.Path(folder, 'deck.nml')
            deck.write_text(text, encoding='utf-8')
            before = os.times()
            begun = time.monotonic()
            try:
                done = subprocess.run([*launcher, program, deck, '--output', folder], env=ENVIRONMENT, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=seconds, check=False)
                self.code, self.said = done.returncode, done.stdout
            except subprocess.TimeoutExpired:
                self.code, self.said = 'timeout', ''
            self.wall = time.monotonic() - begun
            after = os.times()
            self.seconds = after.children_user + after.children_system - before.children_user - before.children_system
            self.rows, self.history = [], b''
            for path in pathlib.Path(folder).glob('*_history.csv'):
                self.history = path.read_bytes()
                with path.open(encoding='utf-8') as lines:
                    self.rows = [{name.strip(): float(value) for name, value in row.items()}
                                 for row in csv.DictReader(line for line in lines if not line.startswith('#'))]
            self.summary, self.log = {}, ''
            for path in pathlib.Path(folder).glob('*_summary.json'):
                self.summary = json.loads(path.read_text(encoding='utf-8'))
            for path in pathlib.Path(folder).glob('*.log'):
                self.log = path.read_text(encoding='utf-8')

    def largest(self, column):
        """Largest value of a column."""
        return max(row[column] for row in self.rows)

    def ledger(self):
        """Least and largest energy error over the impact energy, and the dissipation by surfaces that come into
        contact."""
        impact = self.rows[0]['energy_impactor'] + self.rows[0]['energy_indentation']
        impact = max(impact, self.summary.get('energy_impact') or 0)
        errors = [row['energy_error']/impact for row in self.rows]
        return min(errors), max(errors), self.rows[-1]['energy_contact']/impact

    def wrong(self):
        """Why a run has failed; empty: it has not."""
        if not self.code:
            return ''
        return f'ends with {self.code}: {(self.said.splitlines() or [""])[-1][:100]}'


def explicit(text, keys=''):
    """A deck by central differences, with some keys of &time instead of step, damping and integrator."""
    group = re.search(r'^&time\b[^/]*/', text, re.MULTILINE)[0]
    changed = re.sub(r"\s+(step|rho_inf|integrator)=('\w+'|\S+)", '', group)
    return text.replace(group, f'{changed[:-1].rstrip()} {EXPLICIT} {keys} /')


def row(name, figure, bound='', good=None):
    """Print a row of the table."""
    verdict = '' if good is None else 'holds' if good else '**misses**'
    print(f'| {name} | {figure} | {bound} | {verdict} |', flush=True)


def steps_of(program, text):
    """Number and length of the steps of a run, as estimated by the check; empty if it prints none."""
    said = subprocess.run([program, 'check', '/dev/stdin'], env=ENVIRONMENT, capture_output=True, text=True,
                          input=text, check=False).stdout
    found = re.search(r'About ([\d.e+]+) steps? of ([\d.e+-]+)', said)
    return (float(found[1]), float(found[2])) if found else (None, None)


def panel_text(cell):
    """The 25 J panel with cells of some mm."""
    elements = {3: '20, 30', 1.5: '38, 56', 1: '46, 72'}[cell]
    return change_deck((INPUT/'experiments/t700_m21_25J.nml').read_text(encoding='utf-8'),
                       [f'mesh%elements={elements}', f'mesh%cell={cell}e-3'])
