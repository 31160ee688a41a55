"""Central differences on several ranks: bytewise comparison of histories, and messages and bytes per step."""

import pathlib
import re
import shutil
import subprocess
import tempfile

import numpy as np
from explicit_runs import ENVIRONMENT, MPIRUN, explicit, panel_text, row  # first: sets the path
import breaking_models
import damaging_models
from solver_runs import change_deck

CHECKPOINT = .53  # fraction of the run; its last checkpoint


def history_on(program, folder, number, *arguments):
    """History of a run on some ranks, as bytes; the last printed line if the run fails."""
    done = subprocess.run([*MPIRUN, str(number), program, *arguments], env=ENVIRONMENT, text=True, cwd=folder,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode:
        return f'ends with {done.returncode}: {(done.stdout.splitlines() or [""])[-1][:100]}'
    return next(folder.glob('*_history.csv')).read_bytes()


def rank_texts(options):
    """Decks to be run on several ranks, by name."""
    count = 2 if options.quick else 5
    texts = {f'breaking {seed}': explicit(breaking_models.deck(seed, 1)) for seed in range(count)}
    texts |= {f'damaging {seed}': explicit(damaging_models.deck(damaging_models.model(seed)))
              for seed in range(1, 1 + count)}
    return texts | {'25 J panel, 3 mm, 1 ms': change_deck(panel_text(3), ['time%end=1e-3'])}


def ranks(program, options):
    """Histories on 1, 2, 3 and 4 ranks, and restarted from a checkpoint within the run on each, compared byte for
    byte."""
    for name, text in rank_texts(options).items():
        end = float(re.search(r'\bend=([\d.e+-]+)', text)[1])
        deck = change_deck(text, [f'output%checkpoint_every={CHECKPOINT*end!r}', 'output%checkpoint_at_end=.false.'])
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            found = []
            for number in (1, 2, 3, 4):
                here = root/str(number)
                here.mkdir()
                (here/'deck.nml').write_text(deck, encoding='utf-8')
                found.append(history_on(program, here, number, 'deck.nml', '--output', here))
            for number in (1, 2, 3, 4):
                here = root/f'again_{number}'
                shutil.copytree(root/'1', here)
                history = next(here.glob('*_history.csv'))
                # The folder of a run that was killed before its last rows.
                history.write_bytes(b''.join(history.read_bytes().splitlines(keepends=True)[:-5]))
                found.append(history_on(program, here, number, 'restart', next(here.glob('*_restart.h5'))))
        wrong = [each for each in found if isinstance(each, str)]
        same = [each == found[0] for each in found]
        if wrong:
            row(name, wrong[0], 'same', False)
            continue
        rows, failures = rows_and_failures(found[0])
        row(f'{name} on 1, 2, 3, 4 ranks, restarted on 1, 2, 3, 4',
            f'{", ".join("same" if each else "other" for each in same)}; {rows} rows, {failures:.0f} fibre failures',
            'same', all(same))


def rows_and_failures(history):
    """Number of rows of a history given as bytes, and fibre failures in the last row."""
    lines = [line for line in history.decode('utf-8').splitlines() if not line.startswith('#')]
    names = [name.strip() for name in lines[0].split(',')]
    return len(lines) - 1, float(lines[-1].split(',')[names.index('fibre_failures')])


def sent(folder, ranks):
    """Messages between neighbours, collective calls to each other rank, bytes of both, maximum over the ranks: as
    counted by Open MPI's monitoring."""
    found = np.zeros((ranks, 4))
    for rank in range(ranks):
        for line in (folder/f'count.{rank}.prof').read_text(encoding='utf-8').splitlines():
            entry = re.match(r'([EC])\t(\d+)\t(\d+)\t(\d+) bytes\t(\d+) msgs', line)
            if entry and entry[2] != entry[3]:
                found[rank, 0 if entry[1] == 'E' else 1] += int(entry[5])
                found[rank, 2 if entry[1] == 'E' else 3] += int(entry[4])
    found[:, [1, 3]] /= max(ranks - 1, 1)
    return found


def messages(program, options):
    """Messages and bytes per step on several ranks, and the time on 64 ranks that follows from them."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for cell in options.cells or (3, 1.5):
            text = panel_text(cell)
            for ranks in (2, 4, 8, 16):
                counts, shares = [], None
                for steps in (200, 400):
                    deck = folder/'deck.nml'
                    deck.write_text(change_deck(text, [f'time%end={steps*1.2e-7}', 'output%history_every=1',
                                                       'output%fields_every=1']), encoding='utf-8')
                    done = subprocess.run(
                        ['mpirun', '--allow-run-as-root', '--oversubscribe', '-n', str(ranks), '--mca',
                         'pml_monitoring_enable', '2', '--mca', 'pml_monitoring_enable_output', '3', '--mca',
                         'pml_monitoring_filename', folder/'count', program, deck, '--output', folder],
                        env=ENVIRONMENT, capture_output=True, text=True, check=False)
                    if done.returncode:
                        row(f'{cell} mm on {ranks} ranks', f'ends with {done.returncode}', '', False)
                        return
                    counts.append(sent(folder, ranks))
                    log = next(folder.glob('*.log')).read_text(encoding='utf-8')
                    shares = re.search(r'of (\d+) to (\d+) elements', log)
                neighbours, collective, near, far = np.max(counts[1] - counts[0], axis=0)/200
                row(f'{cell} mm on {ranks} ranks', f'{shares[1]} to {shares[2]} elements a rank, {neighbours:.1f} '
                    f'messages to neighbours of {near:.0f} bytes in all, {collective:.1f} sums over all ranks of '
                    f'{far:.0f} bytes in all, a step')
