#!/usr/bin/env python3
"""Decks with wrong units: `implam check` must name the value and the unit in which it probably is.

usage: check_units.py IMPLAM

Each row changes values of a deck of input/ as by a mistake of units. The decks of input/ themselves get no warning
except that of process zones, which is correct.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

INPUT = pathlib.Path(__file__).resolve().parents[2]/'input'
MODULI = ('E1', 'E2', 'G12', 'G13', 'G23')
# The mistake, the deck, changes (key, factor), and the key that must be named with its unit.
ROWS = (
    ('moduli in GPa', 'sun_chen', tuple((key, 1e-9) for key in MODULI), 'E1', 'GPa'),
    ('moduli in MPa', 'sun_chen', tuple((key, 1e-6) for key in MODULI), 'E1', 'MPa'),
    ('lengths in mm', 'sun_chen', (('length', 1e3), ('patch', 1e3), ('thicknesses', 1e3), ('radius', 1e3),
                                   ('alpha_cr', 1e3)), 'length', 'mm'),
    ('density in g/cm^3', 'sun_chen', (('density', 1e-3),), 'density', 'g/cm^3'),
    ('times in ms', 'sun_chen', (('end', 1e3), ('step', 1e3), ('fields_every', 1e3)), 'end', 'ms'),
    ('radius in mm', 'peanut', (('radius', 800),), 'radius', 'mm'),
    ('velocity in mm/s', 'sun_chen', (('velocity', 1e3),), 'velocity', 'mm/s'),
    ('mass in g', 'sun_chen', (('mass', 1e3),), 'mass', 'g'),
    ('toughness in N/mm', 'peanut', (('G_Ic', 1e-3), ('G_IIc', 1e-3)), 'G_IIc', 'N/mm'),
    ('strengths of an interface in MPa', 'experiments/crossply_0_90',
     (('strength_opening', 1e-6), ('strength_shear', 1e-6)), 'strength_shear', 'MPa'),
    ('k in N/mm^1.5', 'sun_chen', (('k', 10**-4.5),), 'k', 'N/mm^1.5'),
    ('strengths in MPa', 'peanut_cracked', (('XT', 1e-6), ('XC', 1e-6), ('YT', 1e-6), ('YC', 1e-6), ('S12', 1e-6),
                                            ('Sm23', 1e-6)), 'XT', 'MPa'),
    ('strength of the matrix in MPa', 'peanut_cracked', (('YT', 1e-6),), 'YT', 'MPa'),
    ('shear strength in GPa', 'peanut_cracked', (('S12', 1e-9),), 'S12', 'GPa'),
    ('fracture energies of fibres in N/mm', 'experiments/t700_m21_25J', (('G_ft', 1e-3),), 'G_ft', 'N/mm'),
    ('fracture energies of the matrix in N/mm', 'experiments/t700_m21_25J', (('G_mc', 1e-3),), 'G_mc', 'N/mm'),
    # These are errors, besides which the unit is named.
    ('E1 alone in MPa', 'peanut', (('E1', 1e-6),), 'E1', 'MPa'),
    ('E1 alone in GPa', 'peanut', (('E1', 1e-9),), 'E1', 'GPa'),
    ('E2 alone in GPa', 'peanut', (('E2', 1e-9),), 'E2', 'GPa'),
    ('G23 alone in MPa', 'peanut', (('G23', 1e-6),), 'G23', 'MPa'),
    ('thicknesses alone in mm', 'peanut', (('thicknesses', 1e3),), 'thicknesses', 'mm'),
    ('ply_thickness in mm', 'tutorial/plate', (('ply_thickness', 1e3),), 'ply_thickness', 'mm'),
    ('core and cell in mm', 'peanut', (('core', 1e3), ('cell', 1e3)), 'core', 'mm'),
    ('zone in mm', 'peanut', (('zone', 1e3),), 'zone', 'mm'),
    # A drop of 3 J in steps of 1 kg, 4 J of 5.5 kg, and 13.4 m/s.
    ('mass of a drop weight in g', 'peanut', (('mass', 1e3),), 'mass', 'g'),
    ('mass of a heavy drop weight in g', 'peanut', (('mass', 5.5e3),), 'mass', 'g'),
    # 60 g meant as 60 kg: .58 m/s with 10 J.
    ('mass of 60 g', 'tutorial/panel', (('mass', 30),), 'mass', 'g'),
    ('energy in mJ', 'tutorial/panel', (('energy', 1e3),), 'energy', 'mJ'),
    ('clamps in mm', 'tutorial/panel', (('clamps', 1e3),), 'clamps', 'mm'),
    ('corner of the filter in kHz', 'tutorial/panel', (('force_filter', 1e-3),), 'force_filter', 'kHz'),
    ('mass in g beside a velocity', 'experiments/t700_m21_25J', (('mass', 1e3),), 'mass', 'g'),
)


def changed(text, key, factor):
    """The deck with the numbers of a key multiplied."""
    def multiplied(found):
        return found[1] + ', '.join(f'{float(word)*factor:.10g}' for word in found[2].split(','))

    new, times = re.subn(rf'(\b{key} *= *)([-+.\deE]+(?:, *[-+.\deE]+)*)', multiplied, text)
    if times != 1:
        sys.exit(f'{key} is there {times} times.')
    return new


def sandwiches():
    """Decks with a honeycomb core, which has almost no in-plane stiffness and strength."""
    path = INPUT/'sun_chen.nml'
    text = path.read_text()
    for modulus in ('4', '1e6'):
        core = (f"&material name='core' density=48 E1={modulus} E2={modulus} nu12=.3 G12=1e3 G13=2e8 G23=1e8 XT=1e3 /\n"
                "&laminate materials='T300/934', 'core', 'T300/934' angles=0, 0, 0 thicknesses=1e-3, 1e-2, 1e-3 /")
        yield path, re.sub(r'^&laminate.*?/$', core, text, flags=re.MULTILINE | re.DOTALL)


def warnings(program, deck, text=None):
    """Warnings of a check."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, deck.name)
        path.write_text(text or deck.read_text())
        done = subprocess.run([program, 'check', path], capture_output=True, text=True, timeout=60, check=False)
    return [line for line in done.stdout.splitlines() if ': warning: ' in line]


def main(program):
    """Run all rows."""
    named, wrong = 0, []
    for fault, deck, changes, key, unit in ROWS:
        path = INPUT/(deck + '.nml')
        text = ''.join(line for line in path.read_text().splitlines(True) if line[0] != '!')
        for change in changes:
            text = changed(text, *change)
        printed = [line for line in warnings(program, path, text) if f' {key} =' in line and f' in {unit}.' in line]
        named += bool(printed)
        print(f'{fault}: {printed[0].split("warning: ")[1] if printed else "not named"}')
    for path in sorted(INPUT.glob('**/*.nml')):
        wrong += [line for line in warnings(program, path) if 'it is probably in' in line]
    for path, text in sandwiches():
        wrong += [line for line in warnings(program, path, text) if 'it is probably in' in line]
    print(f'{named} of {len(ROWS)} named')
    print('\n'.join(wrong))
    return 0 if named == len(ROWS) and not wrong else 1


if __name__ == '__main__':
    sys.exit(main(sys.argv[1]))
