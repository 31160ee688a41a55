"""Rigs, spherical contact areas and damping to rest on 1 and 3 ranks: the histories are equal to the last bit.
Usage: rig_ranks.py IMPLAM FOLDER LAUNCHER...     (LAUNCHER takes the number of ranks as its last word)

rig      an eccentric impact with a spherical contact area on a unilateral circular frame with clamps of a given force,
         an initial deflection and two interfaces; damped to rest after the contact
elastic  the same impactor on elastic edges of different kinds, with ply failure
curved   a saddle with an initial deflection, interfaces and ply failure
line     damped to rest under pressure on a circular frame, then loaded by lines"""

import sys
from pathlib import Path

from restart import require_same
from solver_runs import exit_code_of, read_history, require, run_deck

STRENGTHS = "XT=2080e6 XC=1250e6 YT=10e6 YC=290e6 S12=20e6 G_ft=133e3 G_fc=10e3 G_mt=500 G_mc=1600"
PLATE = """&mesh elements=10,8 patch=8e-3 /
&material name='ply' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G13=4.8e9 G23=3.8e9 nu12=0.30 nu23=0.35 {strengths} /
&laminate materials='ply' stacking='[0/45/90]' ply_thickness=0.6e-3 /
"""
NOSE = """&impactor mass=0.1e-3 velocity=60 radius=8e-3 at=4e-3,-3e-3 contact_area='sphere' /
&indentation law='hertz' /
"""
INTERFACES = """&delamination below_ply='all' law='cohesive' G_Ic=100 G_IIc=100 strength_opening=5e6 strength_shear=10e6
              friction=0.3 {zone} /
"""
DAMPED = "&time integrator='central_difference' end=60e-6 settle={settle} mass_scaling=10 /\n"
DECKS = {
    "rig": f"""&plate length=80e-3,70e-3 edges='free' in_plane='free' imperfection=0.1e-3 half_waves=2,1 /
&support shape='circle' radius=30e-3 unilateral=.true. /
&support clamps=35e-3,25e-3, -35e-3,25e-3, 35e-3,-25e-3, -35e-3,-25e-3 clamp_force=2 /
{PLATE.format(strengths="")}{NOSE}{INTERFACES.format(zone="")}{DAMPED.format(settle='30e-6')}""",
    "elastic": f"""&plate length=80e-3,70e-3 edges='elastic','elastic','clamped','elastic' imperfection=0.1e-3
       edge_stiffness=1e8 edge_rotation_stiffness=500 /
{PLATE.format(strengths=STRENGTHS)}{NOSE}&ply_damage criteria='hashin' /
{DAMPED.format(settle='30e-6')}""",
    "curved": f"""&plate length=80e-3,70e-3 edges='clamped','clamped','simple','simple' in_plane='tangential'
       curvature_radius=0.2,-0.15 imperfection=0.1e-3 /
{PLATE.format(strengths=STRENGTHS)}{NOSE}&ply_damage criteria='hashin' /
{INTERFACES.format(zone="")}{DAMPED.format(settle='30e-6')}""",
    "line": f"""&plate length=80e-3,70e-3 edges='free' in_plane='free' imperfection=0.1e-3 /
&support shape='circle' radius=30e-3 /
{PLATE.format(strengths="")}{INTERFACES.format(zone="zone=30e-3,30e-3")}&pressure value=2e3 /
&line at=40e-3 component='u' displacement=-0.1e-3 /
&line at=-40e-3 component='u' displacement=0.1e-3 /
&line at=0 direction='x' component='v' displacement=0 /
{DAMPED.format(settle='20e-6')}"""}


def check(implam, folder, launcher):
    """Run every deck on 1 and 3 ranks."""
    for name, text in DECKS.items():
        histories = []
        for ranks in (1, 3):
            deck = folder / name / str(ranks) / "deck.nml"
            deck.parent.mkdir(parents=True, exist_ok=True)
            deck.write_text(f"&case name='{name}' /\n{text}", encoding="utf-8")
            histories.append(run_deck(implam, deck, [*launcher, str(ranks)]))
            require_same(histories[-1], histories[0], f"{name} on {ranks} ranks")
        rows = read_history(histories[0])
        require(max(rows["energy_damping"]) > 0, f"{name} is not damped.")
        print(f"{name}: {len(rows['time'])} rows, the same to the last bit on 1 and 3 ranks", flush=True)


if __name__ == "__main__":
    raise SystemExit(exit_code_of(check, str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]), sys.argv[3:]))
