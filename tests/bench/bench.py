#!/usr/bin/env python3
"""Measures the cost of runs. See README.md beside this file."""
import argparse
import csv
import itertools
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

# Sun and Chen's case with Tan and Sun's indentation, patch of 5 mm. Linear: semi-analytic response.
# With von Karman's strains: 32 x 32 elements on the quarter and steps of 0.5 us.
REFERENCE = {'linear': (298.87, 0.4312e-3), 'von_karman': (298.90, 0.42804e-3)}

DECK = """&case        name='bench'  kinematics='{kinematics}' /
&plate       length=0.2, 0.2  edges='simple'  symmetry='quarter' /
&mesh        elements={elements}, {elements}  patch=5e-3 /
&material    name='T300/934'  density=1580  E1=120e9  E2=7.9e9  G12=5.5e9  G13=5.5e9  G23=5.5e9  nu12=0.30 /
&laminate    materials='T300/934'  angles=0,90,0,90,0,0,90,0,90,0  thicknesses=0.269e-3  shear_correction='5/6' /
&impactor    mass=8.537e-3  velocity=3  radius=6.35e-3  integrator='trapezoidal' /
&indentation law='tan_sun'  k=8.112e8  q=2.5  alpha_cr=80.3e-6  beta=0.094 /
&time        end={end}  step={step}  rho_inf=1 /
{more}
"""

# A cross-ply of seven plies on 12 x 12 elements of a quarter, under an impact too weak for failure; 100 steps.
PANEL = """&case         name='panel'  kinematics='linear' /
&plate        length=0.1, 0.1  edges='clamped'  symmetry='quarter' /
&mesh         elements=12, 12  patch=4e-3 /
&material     name='T300/976'  density=1580  E1=139e9  E2=9.4e9  G12=4.5e9  G13=4.5e9  G23=2.98e9  nu12=0.309
              XT=1517e6  XC=1590e6  YT=46e6  YC=253e6  S12=105e6  Sf=500e6  Sm23=105e6 /
&laminate     materials='T300/976'  angles=0, 90, 0, 90, 0, 90, 0  thicknesses=0.3e-3  shear_correction='5/6' /
&impactor     mass=0.2  velocity=0.2  radius=10e-3 /
&indentation  law='hertz' /
&time         end=400e-6  step=4e-6  integrator='generalized_alpha' /
"""
INTERFACE = '&delamination below_ply={plies} G_Ic=280 G_IIc=790 zone=40e-3, 40e-3 {more} /\n'
# Changes of the deck, or groups added to it.
GROUPS = {
    'as it is: linear, Hertz': [],
    'law of Tan and Sun': [("law='hertz'", "law='tan_sun' alpha_cr=80.3e-6 beta=0.094")],
    "von Karman's strains": [("'linear'", "'von_karman'")],
    'ply damage': [('&time', '&ply_damage /\n&time')],
    'a cohesive interface': [('&time', INTERFACE.format(plies='3', more='') + '&time')],
    'two': [('&time', INTERFACE.format(plies='2, 5', more='') + '&time')],
    'six': [('&time', INTERFACE.format(plies='1, 2, 3, 4, 5, 6', more='') + '&time')],
    'an interface with a front': [('&time', INTERFACE.format(plies='3', more="law='front' starter=8e-3") + '&time')],
}

SUN_CHEN = pathlib.Path(__file__).resolve().parents[2]/'input'/'sun_chen.nml'

# One thread, so that processor time is comparable; Open MPI refuses root unless asked twice.
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS='1', OPENBLAS_NUM_THREADS='1',
                   OMPI_ALLOW_RUN_AS_ROOT='1', OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1')
# A line of the log's table of times.
PHASE = r'^(\S.*?) +(\d+) +([\d.]+) s +([\d.]+) s$'


class Run:
    """One run of the program: processor time, peak memory, and figures from its log and history."""

    def __init__(self, program, kinematics, elements, step, end, more=''):
        with tempfile.TemporaryDirectory() as folder:
            deck = pathlib.Path(folder, 'bench.nml')
            deck.write_text(DECK.format(kinematics=kinematics, elements=elements, step=step, end=end, more=more))
            process = subprocess.Popen([program, deck, '--output', folder], stdout=subprocess.DEVNULL, env=ENVIRONMENT)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode:
                sys.exit(f'The run failed with exit code {process.returncode}.')
            self.seconds = usage.ru_utime + usage.ru_stime
            self.peak_megabytes = usage.ru_maxrss*1024/1e6
            log = pathlib.Path(folder, 'bench.log').read_text()
            with open(pathlib.Path(folder, 'bench_history.csv')) as lines:
                self.history = list(csv.DictReader(line for line in lines if not line.startswith('#')))
        # Name, times, wall-clock seconds, processor seconds.
        self.phases = {name.strip(): (int(times), float(processor)) for name, times, wall, processor in
                       re.findall(PHASE, log, re.MULTILINE)}
        self.wall = {name.strip(): float(wall)/max(int(times), 1) for name, times, wall, processor in
                     re.findall(PHASE, log, re.MULTILINE)}
        self.unknowns = int(re.search(r'(\d+) unknowns', log)[1])
        self.factor_numbers, self.working_megabytes, self.matrix_numbers = (
            float(n) for n in re.search(r'Factor: (\S+) numbers, (\S+) MB; matrix: (\d+) numbers', log).groups())

        # The upper triangle: a number of eight bytes and a column of four each.
        self.matrix_megabytes = 12*(self.matrix_numbers + self.unknowns)/2/1e6
        self.factor_megabytes = 8*self.factor_numbers/1e6

    def mean(self, phase):
        """Processor seconds of one call of a phase."""
        times, seconds = self.phases[phase]
        return seconds/max(times, 1)

    def largest(self, column):
        """Largest value of a column of the history."""
        return max(float(row[column]) for row in self.history)


def step_cost(program, arguments):
    """Cost of a step relative to a solve, share of set-up, and memory, for about 60 000 unknowns."""
    bare = Run(program, 'linear', 2, 1e-6, 1e-6).peak_megabytes
    for kinematics, elements, target in (('linear', 71, 2.5), ('von_karman', 55, 6.0)):
        run = Run(program, kinematics, round(elements*arguments.finer), 1e-6, arguments.steps*1e-6,
                  f"&solver factorization='{arguments.factorization}' /")
        steps, seconds = run.phases['steps']
        solve = run.mean('solve')
        factors, factoring = run.phases['factorization']
        factoring += run.phases['assembly'][1]
        print(f'{kinematics}: {run.unknowns} unknowns, {steps} steps, {run.phases["solve"][0]} solves of '
              f'{1e3*solve:.1f} ms, {factors} factorizations of {1e3*factoring/factors:.0f} ms')
        print(f'  a step over a solve, wall clock: {run.wall["steps"]/run.wall["solve"]:.2f} (at most {target}); '
              f'of the processor {seconds/steps/solve:.2f}; without factorizations '
              f'{(seconds - factoring)/steps/solve:.2f}')
        parts = [part for part in ('solve', 'solve in plane', 'factorization', 'assembly', 'element forces')
                 if part in run.phases]
        for part in parts:
            times, taken = run.phases[part]
            print(f'    {part}: {times} times, {100*taken/seconds:.1f} % of the steps')
        rest = seconds - sum(run.phases[part][1] for part in parts)
        print(f'    all else: {100*rest/seconds:.1f} % of the steps')
        before = run.seconds - seconds - run.phases['results'][1]
        print(f'  before the first step: {before:.2f} s of {run.seconds:.2f} s, {100*before/run.seconds:.1f} %; with '
              f'the first factor {100*(before + factoring/factors)/run.seconds:.1f} % (at most 10 % of 500 steps)')
        print(f'  peak memory {run.peak_megabytes:.0f} MB, {bare:.0f} MB of it with four elements')
        for name, size in (('factor', run.factor_megabytes), ("the package's own memory", run.working_megabytes)):
            both = run.matrix_megabytes + size
            print(f'    over matrix {run.matrix_megabytes:.0f} MB and {name} {size:.0f} MB: '
                  f'{run.peak_megabytes/both:.2f}, {(run.peak_megabytes - bare)/both:.2f} without those (at most 1.5)')


def memory(program, arguments):
    """Peak memory over matrix and factor for several sizes of the model; the limit is 1.5."""
    more = f"&solver factorization='{arguments.factorization}' petsc_options='{arguments.petsc_options}' /"
    bare = Run(program, 'linear', 2, 1e-6, 1e-6, more).peak_megabytes
    print(f'MB; {bare:.0f} MB of each peak with four elements; in brackets the ratio without those')
    print("| strains | unknowns | matrix | factor | package | peak | over matrix, factor | over matrix, package | "
          'processor, s |')
    print('|---|---|---|---|---|---|---|---|---|')
    for kinematics, elements in (('linear', arguments.linear), ('von_karman', arguments.von_karman)):
        for count in elements:
            run = Run(program, kinematics, count, 1e-6, arguments.steps*1e-6, more)
            ratios = ' | '.join(f'{run.peak_megabytes/both:.2f} ({(run.peak_megabytes - bare)/both:.2f})' for both in
                                (run.matrix_megabytes + run.factor_megabytes,
                                 run.matrix_megabytes + run.working_megabytes))
            print(f'| {kinematics} | {run.unknowns} | {run.matrix_megabytes:.0f} | {run.factor_megabytes:.0f} | '
                  f'{run.working_megabytes:.0f} | {run.peak_megabytes:.0f} | {ratios} | {run.seconds:.1f} |',
                  flush=True)


def speed(program, arguments):
    """Accuracy and processor time of Sun and Chen's case, 1000 us, for several meshes and steps."""
    print('| strains | elements | step, us | processor, s | peak force | deflection |')
    print('|---|---|---|---|---|---|')
    for kinematics in ('linear', 'von_karman'):
        for elements in arguments.elements:
            for step in arguments.step:
                runs = [Run(program, kinematics, elements, step*1e-6, 1e-3, arguments.more)
                        for _ in range(arguments.repeat)]
                errors = [100*(runs[0].largest(column)/value - 1) for column, value
                          in zip(('force', 'deflection'), REFERENCE[kinematics], strict=True)]
                seconds = statistics.median(run.seconds for run in runs)
                print(f'| {kinematics} | {elements} x {elements} | {step:g} | {seconds:.2f} | {errors[0]:+.2f} % | '
                      f'{errors[1]:+.2f} % |', flush=True)


def cost(program, text):
    """Processor seconds of one run of a deck, its equilibrium iterations and its factorizations."""
    with tempfile.TemporaryDirectory() as folder:
        deck = pathlib.Path(folder, 'bench.nml')
        deck.write_text(text)
        process = subprocess.Popen([program, deck, '--output', folder], stdout=subprocess.DEVNULL, env=ENVIRONMENT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            sys.exit(f'{program} failed with exit code {process.returncode}.')
        log = next(pathlib.Path(folder).glob('*.log')).read_text()
        counts = re.search(r'(\d+) iterations? of equilibrium.*?(\d+) factori[sz]ations?', log)
        return usage.ru_utime + usage.ru_stime, counts.groups() if counts else ('none',)


def instructions(program, text):
    """Instructions of one run of a deck, counted by valgrind: independent of the load of the machine."""
    with tempfile.TemporaryDirectory() as folder:
        deck = pathlib.Path(folder, 'bench.nml')
        deck.write_text(text)
        counter = ['valgrind', '--tool=callgrind', f'--callgrind-out-file={folder}/counts']
        # valgrind does not support the newest processor instructions, which OpenBLAS would use.
        done = subprocess.run([*counter, program, deck, '--output', folder], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True, env=dict(ENVIRONMENT, OPENBLAS_CORETYPE='HASWELL'))
        if done.returncode:
            sys.exit(f'{program} failed under valgrind ({done.returncode}); was it built with IMPLAM_NATIVE off?')
        return int(re.search(r'Collected : (\d+)', done.stderr)[1])


def absent_physics(program, arguments):
    """Cost of a model without new physics relative to an older program, run alternately; least and median times."""
    old = os.path.abspath(arguments.old)
    text = arguments.deck.read_text()
    decks = {'linear': text, 'von_karman': text.replace("kinematics='linear'", "kinematics='von_karman'")}
    if arguments.as_it_is:
        decks = {arguments.deck.stem: text}
    elif decks['von_karman'] == text:
        sys.exit(f"{arguments.deck} has no kinematics='linear' to change.")
    if arguments.instructions:
        for kinematics, deck in decks.items():
            before, after = instructions(old, deck), instructions(program, deck)
            print(f'{kinematics}: {before/1e9:.3f} and {after/1e9:.3f} thousand million instructions, '
                  f'{after/before:.3f} (at most 1.02)', flush=True)
        return
    print('| strains | old, s | new, s | new/old, least | new/old, median of pairs | old and new iterations, factors |')
    print('|---|---|---|---|---|---|')
    for kinematics, deck in decks.items():
        pairs = []
        for number in range(arguments.repeat):
            # Each program runs first in every other pair, so that neither benefits from the temperature of the machine.
            order = (old, program) if number % 2 == 0 else (program, old)
            costs = {path: cost(path, deck) for path in order}
            pairs.append((costs[old][0], costs[program][0]))
        counts = ' and '.join(', '.join(costs[path][1]) for path in (old, program))
        smallest_old, smallest_new = (min(times) for times in zip(*pairs, strict=True))
        print(f'| {kinematics} | {smallest_old:.3f} | {smallest_new:.3f} | {smallest_new/smallest_old:.3f} | '
              f'{statistics.median(new/before for before, new in pairs):.3f} | {counts} |', flush=True)


def groups(program, arguments):
    """Cost of each group of a deck added to a model without failure: processor time, on request instructions."""
    print('| added | unknowns | iterations, factorizations | processor, s | instructions, 10^9 |')
    print('|---|---|---|---|---|')
    for name, changes in GROUPS.items():
        deck = PANEL
        for old, new in changes:
            deck = deck.replace(old, new)
        costs = [cost(program, deck) for _ in range(arguments.repeat)]
        counted = f'{instructions(program, deck)/1e9:.2f}' if arguments.instructions else '-'
        with tempfile.TemporaryDirectory() as folder:
            run_deck(program, deck, pathlib.Path(folder))
            unknowns = re.search(r'(\d+) unknowns', pathlib.Path(folder, 'panel.log').read_text())[1]
        print(f'| {name} | {unknowns} | {", ".join(costs[0][1])} | {statistics.median(c[0] for c in costs):.3f} | '
              f'{counted} |', flush=True)


def run_deck(program, deck, folder):
    """Runs a deck given as text in a folder; returns processor seconds."""
    folder.joinpath('deck.nml').write_text(deck)
    process = subprocess.Popen([program, folder/'deck.nml', '--output', folder], stdout=subprocess.DEVNULL,
                               env=ENVIRONMENT)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f'The run failed with exit code {process.returncode}.')
    return usage.ru_utime + usage.ru_stime


def history(folder):
    """Rows of the only history in a folder."""
    with next(folder.glob('*_history.csv')).open() as lines:
        return [{key: float(value) for key, value in row.items()} for row in
                csv.DictReader(line for line in lines if not line.startswith('#'))]


def fronts(program, arguments):
    """Forces at which round starters grow on several meshes over the closed form: threshold_1mm.nml."""
    sys.path.insert(0, str(pathlib.Path(__file__).parents[1]/'regress'))
    from front_threshold import growth_ratios
    from solver_runs import change_deck
    deck = pathlib.Path(__file__).parents[2].joinpath('input/reference/threshold_1mm.nml').read_text()
    print('| cell, mm | starter, mm | first growth | least, mean, largest after steps with growth | largest step of '
          'the growth, mm^2 | released over recorded | processor, s |')
    print('|---|---|---|---|---|---|---|')
    for cell, starter in itertools.product(arguments.cell, arguments.starter):
        elements = round(20/cell) + 6
        settings = [f'mesh%cell={cell}e-3', f'mesh%elements={elements},{elements}', f'time%end={arguments.end}',
                    f'delamination%starter={starter}e-3', "delamination%starter_shape='round'"]
        with tempfile.TemporaryDirectory() as name:
            seconds = run_deck(program, change_deck(deck, settings), pathlib.Path(name))
            rows = history(pathlib.Path(name))
        first, ratios, areas = growth_ratios(rows)
        mean = sum(ratio*area for ratio, area in zip(ratios, areas, strict=True))/sum(areas)
        print(f'| {cell:g} | {starter:g} | {first:.3f} | {min(ratios):.3f}, {mean:.3f}, {max(ratios):.3f} | '
              f'{1e6*max(areas):.0f} of {1e6*sum(areas):.0f} | '
              f'{rows[-1]["energy_released"]/rows[-1]["energy_delamination"]:.3f} | {seconds:.0f} |', flush=True)


def growth(program, arguments):
    """Forces at which fronts grow and the energy they release: the threshold deck, and a cross-ply with several
    steps."""
    decks = pathlib.Path(__file__).parents[2]/'input'
    crossply = decks.joinpath('reference/crossply_2mm.nml').read_text()
    crossply = crossply.replace("'two_state'", "'vcct'").replace("'one_per_step'", "'equilibrium'")
    runs = [('threshold_1mm', decks.joinpath('reference/threshold_1mm.nml').read_text())]
    runs += [('crossply_2mm', re.sub(r'step=\S+', f'step={step}e-6', crossply)) for step in arguments.step]
    print('| deck | step, us | force in steps with growth, N | area, mm^2 | released over recorded | algorithmic, J |')
    print('|---|---|---|---|---|---|')
    for name, deck in runs:
        with tempfile.TemporaryDirectory() as folder:
            run_deck(program, deck, pathlib.Path(folder))
            rows = history(pathlib.Path(folder))
        force = statistics.mean(later['force'] for row, later in itertools.pairwise(rows)
                                if later['delaminated_area'] > row['delaminated_area'])
        step = 1e6*float(re.search(r'step=(\S+)', deck)[1])
        print(f'| {name} | {step:g} | {force:.0f} | {1e6*rows[-1]["delaminated_area"]:.0f} | '
              f'{rows[-1]["energy_released"]/rows[-1]["energy_delamination"]:.3f} | '
              f'{rows[-1]["energy_algorithmic"]:.4f} |', flush=True)


def growth_force(rows):
    """Force at which G/G_c first reaches 1, from the last row before growth; NaN without growth or without a front."""
    # G is slightly below its critical value there, and proportional to the square of the force.
    for row, later in itertools.pairwise(rows):
        if later['delaminated_area'] > 1.001*rows[0]['delaminated_area']:
            return row['force']/row['release_ratio']**0.5 if row['release_ratio'] > 0 else float('nan')
    return float('nan')


def one_deck(program, arguments):
    """Figures of one deck with changed keys: growth, forces, area, energies, steps and cost."""
    sys.path.insert(0, str(pathlib.Path(__file__).parents[1]/'regress'))
    from solver_runs import change_deck
    print('| set | G = G_c, first growth by, N | peak force, N | mean force of growth, N | area, mm^2 | '
          'released over recorded | algorithmic, J | fibre failures, cracks | steps, factorizations | processor, s |')
    print('|---|---|---|---|---|---|---|---|---|---|')
    for settings in arguments.set or [[]]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            seconds = run_deck(program, change_deck(arguments.deck.read_text(), settings), folder)
            rows = history(folder)
        forces, areas, last = [row['force'] for row in rows], [row['delaminated_area'] for row in rows], rows[-1]
        grown = [place for place in range(1, len(rows)) if areas[place] > areas[place - 1]]
        first, by, mean, released = growth_force(rows), float('nan'), float('nan'), float('nan')
        if grown:
            by = max(forces[:grown[0] + 1])
            mean = sum(forces[i]*(areas[i] - areas[i - 1]) for i in grown)/(areas[-1] - areas[0])
            released = last['energy_released']/last['energy_delamination']
        print(f'| {" ".join(settings) or "as it is"} | {first:.0f}, {by:.0f} | {max(forces):.0f} | {mean:.0f} | '
              f'{1e6*last["delaminated_area"]:.0f} | {released:.3f} | {last["energy_algorithmic"]:.4f} | '
              f'{last["fibre_failures"]:.0f}, {last["matrix_cracks"]:.0f} | {last["step"]:.0f}, '
              f'{last["refactorisations"]:.0f} | {seconds:.1f} |', flush=True)


def main():
    """Reads the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('program', help='path of implam')
    parts = parser.add_subparsers(required=True)
    part = parts.add_parser('step-cost', help=step_cost.__doc__)
    part.add_argument('--steps', type=int, default=500)
    part.add_argument('--finer', type=float, default=1, help='factor of the number of elements along a side')
    part.add_argument('--factorization', default='automatic', help='of &solver')
    part.set_defaults(act=step_cost)
    part = parts.add_parser('memory', help=memory.__doc__)
    part.add_argument('--linear', type=int, nargs='*', default=[71, 100, 142, 205], help='elements along a side')
    part.add_argument('--von-karman', type=int, nargs='*', default=[55, 77, 110, 159], help='likewise')
    part.add_argument('--steps', type=int, default=5)
    part.add_argument('--factorization', default='automatic')
    part.add_argument('--petsc-options', default='')
    part.set_defaults(act=memory)
    part = parts.add_parser('speed', help=speed.__doc__)
    part.add_argument('--elements', type=int, nargs='+', default=[8, 12, 16, 24])
    part.add_argument('--step', type=float, nargs='+', default=[8, 4, 2, 1], help='us')
    part.add_argument('--repeat', type=int, default=3)
    part.add_argument('--more', default='', help='groups added to the deck')
    part.set_defaults(act=speed)
    part = parts.add_parser('absent-physics', help=absent_physics.__doc__)
    part.add_argument('old', help='path of the implam to compare with')
    part.add_argument('--deck', type=pathlib.Path, default=SUN_CHEN, help='elastic deck with linear strains')
    part.add_argument('--as-it-is', action='store_true', help='the deck alone, not with linear and other strains')
    part.add_argument('--repeat', type=int, default=10)
    part.add_argument('--instructions', action='store_true', help='count them by valgrind instead of taking times')
    part.set_defaults(act=absent_physics)
    part = parts.add_parser('growth', help=growth.__doc__)
    part.add_argument('--step', type=float, nargs='*', default=[16, 8, 4, 2, 1], help='us')
    part.set_defaults(act=growth)
    part = parts.add_parser('fronts', help=fronts.__doc__)
    part.add_argument('--cell', type=float, nargs='+', default=[2, 1, 0.5], help='mm')
    part.add_argument('--starter', type=float, nargs='+', default=[10, 20], help='mm')
    part.add_argument('--end', type=float, default=7.6e-3, help='s')
    part.set_defaults(act=fronts)
    part = parts.add_parser('groups', help=groups.__doc__)
    part.add_argument('--repeat', type=int, default=5)
    part.add_argument('--instructions', action='store_true', help='count them by valgrind, too')
    part.set_defaults(act=groups)
    part = parts.add_parser('deck', help=one_deck.__doc__)
    part.add_argument('deck', type=pathlib.Path)
    part.add_argument('--set', nargs='+', action='append', metavar='GROUP%%KEY=VALUE',
                      help='changed keys; given again: another run')
    part.set_defaults(act=one_deck)
    arguments = parser.parse_args()
    arguments.act(os.path.abspath(arguments.program), arguments)


if __name__ == '__main__':
    main()
