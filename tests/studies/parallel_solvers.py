#!/usr/bin/env python3
"""Linear solvers on several ranks: MUMPS, CHOLMOD on one rank, BDDC, and Schur complements, by operations and messages.
Usage: parallel_solvers.py PROGRAM [--cells N ...] [--ranks N ...] [--methods NAME ...] [--static] [--messages]

PROGRAM is built by `cmake --build build --target parallel_solvers`. It assembles the tangent of a step of 1 us of a
laminate with von Karman's strains, five unknowns a node, on the ranks of METIS' decomposition; with --static the
tangent of a load step. Prints a row for each method and number of ranks:

unknowns, method, ranks; processor time of a factorization and of a solve to 1e-6, s; iterations of a solve; operations
of both on the busiest rank, 1e9; messages and MB that the busiest rank sends in both, and sums over all ranks, counted
by Open MPI's monitoring and PETSc's log; memory of all ranks, MB; residual over load. Times hold for at most one rank a
core; with more they include waiting. The factorization is the second one of a run, without the symbolic phase.
Operations of methods with Schur complements are wrong, since PETSc 3.18 reads other counters of MUMPS."""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

DECK = """&case        name='study'  kinematics='von_karman' /
&plate       length=0.2, 0.2  edges='simple'  symmetry='quarter' /
&mesh        elements={cells}, {cells}  patch=5e-3 /
&material    name='T300/934'  density=1580  E1=120e9  E2=7.9e9  G12=5.5e9  G13=5.5e9  G23=5.5e9  nu12=0.30 /
&laminate    materials='T300/934'  angles=0,90,0,90,0,0,90,0,90,0  thicknesses=0.269e-3  shear_correction='5/6' /
&impactor    mass=8.537e-3  velocity=3  radius=6.35e-3 /
&time        end=1e-6  step=1e-6  rho_inf=1 /
"""
BDDC = ('-study_parts -ksp_type cg -ksp_norm_type unpreconditioned -pc_bddc_use_nnsp '
        '-pc_bddc_dirichlet_pc_type cholesky -pc_bddc_dirichlet_pc_factor_mat_solver_type cholmod '
        '-pc_bddc_neumann_pc_type cholesky -pc_bddc_neumann_pc_factor_mat_solver_type cholmod '
        '-pc_bddc_dirichlet_mat_cholmod_factor supernodal -pc_bddc_neumann_mat_cholmod_factor supernodal ')
# Name of each method: its options. RANKS stands for the number of ranks.
METHODS = {
    'CHOLMOD': '-ksp_type preonly -pc_type cholesky -pc_factor_mat_solver_type cholmod',
    'gathered': '-ksp_type preonly -pc_type telescope -pc_telescope_reduction_factor RANKS',
    'MUMPS': '-ksp_type preonly -pc_type cholesky -pc_factor_mat_solver_type mumps -mat_mumps_icntl_13 1',
    'BDDC': BDDC,
    'deluxe': BDDC + '-pc_bddc_use_deluxe_scaling',
    'adaptive': BDDC + '-pc_bddc_use_deluxe_scaling -pc_bddc_adaptive_threshold 5',
}
# Solves of a run, for their mean
SOLVES = 11
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS='1', OPENBLAS_NUM_THREADS='1', OMPI_ALLOW_RUN_AS_ROOT='1',
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1', OMPI_MCA_mpi_yield_when_idle='1')
MONITORING = ['--mca', 'pml_monitoring_enable', '2', '--mca', 'pml_monitoring_enable_output', '3', '--mca',
              'pml_monitoring_filename']


def sent(folder, ranks):
    """Messages and bytes sent by each rank, counted by Open MPI's monitoring."""
    found = np.zeros((ranks, 2))
    for rank in range(ranks):
        for line in (folder/f'count.{rank}.prof').read_text(encoding='utf-8').splitlines():
            entry = re.match(r'[EI]\t(\d+)\t(\d+)\t(\d+) bytes\t(\d+) msgs', line)
            if entry and entry[1] != entry[2]:
                found[rank] += [int(entry[4]), int(entry[3])]
    return found


def run(program, cells, ranks, options, repeats):
    """Figures of a run with given numbers of factorizations and solves, and the messages of each rank; None if it
    fails."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder/'deck.nml').write_text(DECK.format(cells=cells), encoding='utf-8')
        command = ['mpirun', '--oversubscribe', '-n', str(ranks), *MONITORING, folder/'count', program,
                   folder/'deck.nml', '-study_factors', str(repeats[0]), '-study_solves', str(repeats[1]),
                   '-ksp_rtol', '1e-6', '-log_view', *options.replace('RANKS', str(ranks)).split()]
        done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
        line = re.search(r'^study (.*)$', done.stdout, re.MULTILINE)
        if not line:
            print(f'{" ".join(map(str, command))}\n{done.stdout}{done.stderr}'[:3000], file=sys.stderr)
            return None
        # PETSc's persistent messages, which the monitoring misses, and its reductions.
        own = [float(re.search(rf'^MPI {words}: +(\S+)', done.stdout, re.MULTILINE)[1])
               for words in ('Msg Count', r'Msg Len \(bytes\)', 'Reductions')]
        counted = np.append(np.max(sent(folder, ranks), axis=0), 0) + own
        return [float(word) for word in line[1].split()], counted/[1, 1e6, 1]


def row(program, cells, ranks, options, counts_messages):
    """Cells of a row. The messages of a factorization or a solve are the difference of two runs."""
    figures = run(program, cells, ranks, options, (2, SOLVES))
    if figures is None:
        return ['', '', f'{ranks}', 'failed']
    (unknowns, factor, solve, operations, of_solve, iterations, memory, error), both = figures
    messages = [''] * 6
    if counts_messages and ranks > 1:
        of_one_factor = run(program, cells, ranks, options, (1, SOLVES))[1]
        of_one_solve = run(program, cells, ranks, options, (2, 1))[1]
        messages = [f'{value:.3g}' for value in np.append(both - of_one_factor, (both - of_one_solve)/(SOLVES - 1))]
    return [f'{unknowns:.0f}', '', f'{ranks}', f'{factor:.2f}', f'{solve/SOLVES:.3f}', f'{iterations:.0f}',
            f'{operations/1e9:.2f}', f'{of_solve/SOLVES/1e9:.3f}', *messages, f'{memory/1e6:.0f}', f'{error:.0e}']


def main():
    """Print a row for each method and number of ranks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('program')
    parser.add_argument('--cells', type=int, nargs='+', default=[100, 223], help='along a side of the quarter')
    parser.add_argument('--ranks', type=int, nargs='+', default=[1, 2, 4, 8, 16])
    parser.add_argument('--methods', nargs='+', default=list(METHODS), choices=METHODS)
    parser.add_argument('--static', action='store_true', help='load steps instead of time steps')
    parser.add_argument('--messages', action='store_true', help='count them, by two further runs')
    parser.add_argument('--more', default='', help='further options of PETSc')
    arguments = parser.parse_args()
    print('| unknowns | method | ranks | factor, s | solve, s | iterations | factor, 1e9 | solve, 1e9 | messages of a '
          'factor | MB | sums | of a solve | MB | sums | memory, MB | error |')
    print('|---'*16 + '|')
    for cells in arguments.cells:
        for name in arguments.methods:
            for ranks in arguments.ranks:
                if (name == 'CHOLMOD') != (ranks == 1) and name != 'MUMPS':
                    continue
                options = METHODS[name] + ' ' + arguments.more + ('' if arguments.static else ' -study_step 1e-6')
                cell = row(os.path.abspath(arguments.program), cells, ranks, options, arguments.messages)
                cell[1] = name
                print('| ' + ' | '.join(cell) + ' |', flush=True)


if __name__ == '__main__':
    main()
