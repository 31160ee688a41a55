"""The fields that a deck chooses: those and no others are written, as `implam explain fields` says, and stresses and
energy release rates are right. Usage: chosen_fields.py IMPLAM FOLDER"""

import re
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
from implam_post.io.deck import read_deck
from implam_post.laminate.decks import plies_of, section_of_deck
from implam_post.reference.navier import Plate

from solver_runs import exit_code_of, read_history, require, run_deck, write_deck

# Nodes of an element in the file, as 1 + i + 3 j.
ORDER = np.array([1, 3, 9, 7, 2, 6, 8, 4, 5])
GAUSS = np.sqrt(0.6) * np.array([-1, 0, 1])
WEIGHTS = np.array([5, 8, 5]) / 9
IN_PLANE, TRANSVERSE = ("sigma11", "sigma22", "tau12"), ("tau13", "tau23")


class Results:
    """The last written time of NAME.h5: mesh and fields."""

    def __init__(self, history_path):
        """Read mesh and fields."""
        with h5py.File(str(history_path).removesuffix("_history.csv") + ".h5") as file:
            last = file["times"][max(file["times"])]
            mesh = file[f"meshes/{int(last['mesh'][()]):08d}"]
            self.coordinates = mesh["coordinates"][()]
            self.connectivity = mesh["connectivity"][()][:, np.argsort(ORDER)]
            self.first_ply, self.last_ply = (mesh[f"cells/{name}"][()].ravel() for name in ("first_ply", "last_ply"))
            self.points = {name: item[()] for name, item in last.get("points", {}).items()}
            self.cells = {name: item[()].ravel() for name, item in last.get("cells", {}).items()}
        corners = self.coordinates[self.connectivity[:, [0, 8]], :2]
        self.low, self.high = corners[:, 0], corners[:, 1]

    def mean_strains(self):
        """Return membrane strains (von Karman) and curvatures from the nodes, as means of the nine Gauss points."""
        u, v, w = self.points["displacement"][self.connectivity].transpose(2, 0, 1)
        # Two components become two scalars in the file.
        tx, ty = (self.points[f"rotation_{i}"].ravel()[self.connectivity] for i in (1, 2))
        strains = 0
        for p, along in enumerate(GAUSS):
            for q, across in enumerate(GAUSS):
                x, y = self.derivatives(along, across)
                slopes = np.sum(x * w, axis=1), np.sum(y * w, axis=1)
                rows = [np.sum(term, axis=1) for term in (x * u, y * v, y * u + x * v, x * tx, y * ty, y * tx + x * ty)]
                rows[0] = rows[0] + slopes[0]**2 / 2
                rows[1] = rows[1] + slopes[1]**2 / 2
                rows[2] = rows[2] + slopes[0] * slopes[1]
                strains = strains + WEIGHTS[p] * WEIGHTS[q] / 4 * np.array(rows)
        return strains[:3].T, strains[3:].T

    def derivatives(self, along, across):
        """Return the derivatives of the nine shape functions by x and by y at a position in each element."""
        def shapes(t):
            return np.array([t * (t - 1), 2 * (1 - t * t), t * (t + 1)]) / 2, np.array([t - 0.5, -2 * t, t + 0.5])
        (a, da), (b, db) = shapes(along), shapes(across)
        sides = self.high - self.low
        return (np.outer(b, da).ravel() * 2 / sides[:, :1], np.outer(db, a).ravel() * 2 / sides[:, 1:])


def heights(plies):
    """Return z of the surfaces of the plies from the mid-plane."""
    thicknesses = [ply.thickness for ply in plies]
    return np.concatenate([[0], np.cumsum(thicknesses)]) - sum(thicknesses) / 2


def turned(angle, strains):
    """Return strains in the axes of a ply."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return strains @ np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]]).T


def ply_stresses(material, angle, strains, failures):
    """Return sigma11, sigma22 and tau12 for strains in the axes of the plate, with the stiffness left by failures
    (Table 2)."""
    fibre, cracked, crushed = (failures & bit > 0 for bit in (1, 2, 4))
    left = [np.maximum(0.01**np.sum(modes, axis=0), 1e-3)
            for modes in ([fibre], [fibre, cracked], [fibre, cracked, crushed])]
    e1, g12 = material.e1 * left[0], material.g12 * left[1]
    e2, nu12 = material.e2 * left[2], material.nu12 * left[2]
    e = turned(angle, strains)
    scale = 1 - nu12**2 * e2 / e1
    return np.array([(e1 * e[:, 0] + nu12 * e2 * e[:, 1]) / scale, (nu12 * e2 * e[:, 0] + e2 * e[:, 1]) / scale,
                     g12 * e[:, 2]])


def navier_strains(deck, results, amplitude):
    """Return curvatures and shear strains of Navier's plate, exact means over the elements."""
    plate = Plate(section_of_deck(deck), deck.lengths())
    w, x, y = np.linalg.solve(plate.stiffness(np.array(1), np.array(1)), [amplitude, 0, 0])
    a, b = np.pi / np.array(plate.lengths)
    arguments = np.array([a, b]) * np.array([results.low, results.high])
    sides = results.high - results.low
    # The struck point is the origin: half-sines are cosines here.
    cosine = np.diff(np.sin(arguments), axis=0)[0] / ([a, b] * sides)
    sine = -np.diff(np.cos(arguments), axis=0)[0] / ([a, b] * sides)
    both, mixed, (x_only, y_only) = np.prod(cosine, axis=1), np.prod(sine, axis=1), (
        sine[:, 0] * cosine[:, 1], cosine[:, 0] * sine[:, 1])
    curvatures = np.array([-a * x * both, -b * y * both, (b * x + a * y) * mixed]).T
    return curvatures, -np.array([(a * w + x) * x_only, (b * w + y) * y_only]).T


def shares_of_crossply(plies):
    """Return the mean tau_xz and tau_yz of each ply for Qx = Qy = 1, by equilibrium of its bending stresses."""
    z = heights(plies)
    stiffness = [ply.material.reduced_stiffness(ply.angle)[:2, :2] for ply in plies]
    bending = sum(q * (high**3 - low**3) / 3 for q, low, high in zip(stiffness, z[:-1], z[1:], strict=True))
    carried, shares = np.zeros(2), []
    for q, low, high in zip(stiffness, z[:-1], z[1:], strict=True):
        # Growth along x under Qx = Mx,x, along y under Qy = My,y; the stress carried at z is s - e (z**2 - low**2)/2.
        e = np.diag(q @ np.linalg.inv(bending))
        shares.append(carried - e / 2 * ((high**3 - low**3) / (3 * (high - low)) - low**2))
        carried = carried - e * (high**2 - low**2) / 2
    return np.array(shares)


def check_navier(implam, folder):
    """All five stresses in each ply of a plate with a known solution."""
    names = [f"ply_{ply}_{name}" for ply in (1, 2, 3) for name in IN_PLANE + TRANSVERSE]
    faces = [f"ply_{ply}_{name}_{face}" for ply in (1, 2, 3) for name in IN_PLANE for face in ("top", "bottom")]
    deck_path = write_deck(folder / "navier", "navier_laminate.nml",
                           ["mesh%elements=12,12", "output%fields='Stress, face_stress'"])
    results, deck = Results(run_deck(implam, deck_path)), read_deck(deck_path)
    require(not results.points and set(results.cells) == {*names, *faces}, f"There are {sorted(results.cells)}.")
    curvatures, shear = navier_strains(deck, results, deck.number("pressure", "value"))
    plies = plies_of(deck)
    forces = 5 / 6 * shear @ sum(ply.thickness * ply.material.transverse_shear_stiffness(ply.angle) for ply in plies)
    z, worst, sound = heights(plies), 0.0, np.zeros(len(curvatures), dtype=int)
    for number, ply in enumerate(plies, start=1):
        places = {"": (z[number - 1] + z[number]) / 2, "_top": z[number - 1], "_bottom": z[number]}
        largest = max(map(abs, places.values()))
        for suffix, place in places.items():
            scales, rights = (ply_stresses(ply.material, ply.angle, height * curvatures, sound)
                              for height in (largest, place))
            for scale, right, name in zip(scales, rights, IN_PLANE, strict=True):
                found = results.cells[f"ply_{number}_{name}{suffix}"]
                worst = max(worst, np.max(np.abs(found - right)) / np.max(np.abs(scale)))
        c, s = np.cos(np.radians(ply.angle)), np.sin(np.radians(ply.angle))
        carried = forces * shares_of_crossply(plies)[number - 1] @ np.array([[c, -s], [s, c]])
        for right, name in zip(carried.T, TRANSVERSE, strict=True):
            found = results.cells[f"ply_{number}_{name}"]
            worst = max(worst, np.max(np.abs(found - right)) / np.max(np.abs(right)))
    print(f"Navier's plate: the worst stress is {worst:.1e} of the largest of its kind off")
    require(worst < 1e-5, "The stresses are not those of Navier's plate.")


def check_damaged_layers(implam, folder):
    """Stresses of layers with some failed plies, against strains from the nodal displacements."""
    deck_path = write_deck(folder / "damage", "../small/damage.nml",
                           ["output%fields='displacement','rotation','ply_damage','stress','face_stress'"])
    results, plies = Results(run_deck(implam, deck_path)), plies_of(read_deck(deck_path))
    require("jump" not in results.points and "delaminated_above" not in results.cells, "There are other fields.")
    membrane, curvature = results.mean_strains()
    z, worst, failed = heights(plies), 0.0, 0
    for number, ply in enumerate(plies, start=1):
        inside = (results.first_ply <= number) & (number <= results.last_ply)
        failures = results.cells[f"ply_{number}_failure"].astype(int)
        failed += np.count_nonzero(failures[inside])
        for suffix, place in (("", (z[number - 1] + z[number]) / 2), ("_top", z[number - 1]), ("_bottom", z[number])):
            rights = ply_stresses(ply.material, ply.angle, membrane + place * curvature, failures)
            for right, name in zip(rights, IN_PLANE, strict=True):
                found = results.cells[f"ply_{number}_{name}{suffix}"]
                require(not np.any(found[~inside]), f"{name} of ply {number} is non-zero in elements without this ply.")
                worst = max(worst, np.max(np.abs(found - right)[inside]) / np.max(np.abs(right)))
    require(failed > 0, "No ply failed.")
    print(f"damaged layers: {failed} failures; the worst stress is {worst:.1e} of the largest of its kind off")
    require(worst < 1e-13, "The stresses are not those of the nodal displacements.")


def check_energy_release(implam, folder):
    """G/G_c is non-zero only in intact cells along the front, and its largest value is that of the history."""
    history_path = run_deck(implam, write_deck(folder / "release", "../small/delamination.nml",
                                               ["output%fields='delamination,energy_release'"]))
    results = Results(history_path)
    require(set(results.points) == {"damage_above", "dissipated_above", "shear_share_above"}
            and set(results.cells) == {"delaminated_above", "energy_release_above"},
            f"There are {sorted(results.points)} and {sorted(results.cells)}.")
    ratio, apart = results.cells["energy_release_above"], results.cells["delaminated_above"] > 0
    below = results.first_ply == 3
    expected = read_history(history_path)["release_ratio"][-1]
    require(abs(np.max(ratio) - expected) < 1e-12 * expected, f"{np.max(ratio)} instead of {expected}.")
    require(np.all(np.isfinite(ratio)) and np.all(ratio >= 0), "A rate is negative or no number.")
    tiny = 1e-9 * np.max(results.high)
    for i in np.flatnonzero(ratio > 0):
        common = np.minimum(results.high[i], results.high) - np.maximum(results.low[i], results.low)
        beside = np.all(common > -tiny, axis=1) & (np.sum(common > tiny, axis=1) == 1)
        require(below[i] and not apart[i], "There is a rate where the interface is not intact.")
        require(np.any(apart & beside), "A rate is given away from the front.")
    print(f"energy release: {np.count_nonzero(ratio)} cells ahead of the front, G/G_c up to {np.max(ratio):.3f}")


STRIP = """&case name='strip' kinematics='linear' /
&plate length=0.1, 0.02  edges='free' /
&mesh elements=20, 2 /
&material name='c'  density=1600  E1=130e9 E2=8e9 G12=5e9 G13=5e9 G23=4e9 nu12=0 YT=60e6 S12=50e6 /
&laminate materials='c'  angles=0,90,0  thicknesses=0.5e-3,1e-3,0.5e-3 /
&line at=-0.04  displacement=0 /
&line at=0.04  displacement=0 /
&line at=0  force=100 /
&static steps=1 /
&output fields='onset' /
"""
# With the interface it is the same strip; with the starter the lower layer is separate from 10 to 30 mm.
JOINED = "&delamination below_ply=2 G_c=1e3 law='cohesive' zone=0.06,0.02 /\n"
APART = JOINED.replace("G_c", "starter_strip=0.01,0.03 G_c")


def check_onset(implam, folder):
    """The index of a bent strip is the shear stress of beam theory, Q/D times the first moment of the outer part."""
    outer, inner = 1e-3, 0.5e-3
    bending = 2 * (130e9 * (outer**3 - inner**3) + 8e9 * inner**3) / 3
    expected = 50 / 0.02 / bending * 130e9 * (outer**2 - inner**2) / 2 / 50e6
    for name, more in (("whole", ""), ("joined", JOINED), ("apart", APART)):
        (folder / name).mkdir(parents=True, exist_ok=True)
        (folder / name / "deck.nml").write_text(STRIP + more, encoding="utf-8")
        results = Results(run_deck(implam, folder / name / "deck.nml"))
        index, ply = results.cells["onset_index"], results.cells["onset_ply"]
        middle = (results.low[:, 0] + results.high[:, 0]) / 2
        loaded = (np.abs(middle) < 0.04) & ((name != "apart") | (np.abs(middle - 0.02) > 0.03))
        worst = np.max(np.abs(index[loaded] / expected - 1))
        print(f"onset, {name}: {np.count_nonzero(loaded)} elements, {worst:.1e} off beam theory")
        require(worst < 1e-11, "The index is not that of beam theory.")
        require(set(ply[loaded]) <= {1, 2}, "The largest index is in another interface.")
        alone = (np.abs(middle - 0.02) < 0.009) & (results.first_ply == 3)
        require(name != "apart" or (np.any(alone) and not np.any(index[alone])), "An index is given for a single ply.")


INDENTED = """&case name='indented' kinematics='linear' /
&plate length=0.06, 0.06  edges='clamped'  symmetry='quarter' /
&mesh elements=30, 30  patch=4e-3 /
&material name='c'  density=1600  E1=130e9 E2=8e9 G12=5e9 G13=5e9 G23=4e9 nu12=0.3 YT=1e3 S12=1e12 /
&laminate materials='c'  angles=0,90,0  thicknesses=0.5e-3,1e-3,0.5e-3 /
&impactor travel=1e-3  radius=1 /
&indentation law='hertz'  k=1e12 /
&static steps=1 /
"""
LAYERED = """&delamination below_ply={}  G_c=1e13  law='cohesive'  zone=0.06,0.06  strength_opening=1e12
  strength_shear=1e12  stiffness=1e15  contact='none' /
"""


def check_opening(implam, folder):
    """The index of opening alone is the force that ties two layers beside the load."""
    fields = {0: "onset", 1: "gap", 2: "gap"}
    results = {}
    for below, field in fields.items():
        place = folder / f"indented_{below}"
        place.mkdir(parents=True, exist_ok=True)
        deck = INDENTED + f"&output fields='{field}' /\n" + LAYERED.format(below) * (below > 0)
        (place / "deck.nml").write_text(deck, encoding="utf-8")
        results[below] = Results(run_deck(implam, place / "deck.nml"))
    weights = np.outer([1, 4, 1], [1, 4, 1]).ravel() / 36
    middles = {below: np.round((found.low + found.high) / 2, 9) for below, found in results.items()}
    held = np.zeros(len(middles[0]))
    for below in (1, 2):
        under = results[below].first_ply == below + 1
        require(np.array_equal(middles[below][under], middles[0]), "The cells differ.")
        gap = results[below].points["jump"][results[below].connectivity[under]][:, :, 2] @ weights
        held = np.maximum(held, 1e15 * gap)
    away = np.hypot(*middles[0].T)
    opening = 1e3 * results[0].cells["onset_index"]
    beside = (away > 5e-3) & np.all(middles[0] < 20e-3, axis=1)
    worst = np.max(np.abs(opening - held)[beside]) / np.max(held[beside])
    print(f"opening: up to {np.max(held[beside]):.3g}, {worst:.3f} of it from the tie stress of the layers")
    require(worst < 0.1, "The opening stress is not the tie stress of the layers.")
    near = (away > 3e-3) & np.all(middles[0] < 20e-3, axis=1)
    worst = np.max(np.abs(opening - held)[near]) / np.max(held[near])
    print(f"nearer, up to {np.max(held[near]):.3g}, {worst:.3f} of it off")
    require(worst < 0.28, "The opening stress is far from the tie stress of the layers near the patch.")
    pressed = np.all(middles[0] < 2e-3, axis=1)
    require(np.max(opening[pressed]) < 1e-3 * np.max(held), "A load from above opens the interface under it.")


SCATTER = ["plate%symmetry='none'", "ply_damage%weibull_modulus=41", "ply_damage%reference_volume=3750e-9",
           "ply_damage%strength_seed=1", "ply_damage%strength_length=1e-3"]
STRINGER = ["stringer%name='web'", "stringer%height=10e-3", "stringer%thickness=1e-3", "stringer%E=70e9",
            "stringer%density=1600"]


def table_of(implam, topic):
    """Return the rows of a table of results, each a list of cells, without the heading."""
    command = [implam, "explain", topic, "--markdown"]
    lines = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return [[cell.strip(" `") for cell in line.strip("| ").split(" | ")] for line in lines[2:]]


def fields_of(history_path):
    """Return place, unit and meaning of the fields in a file by their names, N being the number of a ply."""
    found = {}
    with h5py.File(str(history_path).removesuffix("_history.csv") + ".h5") as file:
        last = file["times"][max(file["times"])]
        groups = {"cells": [file["meshes/00000001/cells"], last.get("cells", {})], "points": [last.get("points", {})]}
        for place, name, item in ((p, *pair) for p, held in groups.items() for group in held for pair in group.items()):
            texts = (item.attrs[what].decode() for what in ("unit", "meaning"))
            found[re.sub(r"^ply_\d+_", "ply_N_", name)] = (place, *texts)
    return found


def check_table(implam, folder):
    """Each choice writes the fields of the table, with their units and meanings; likewise the columns."""
    rows = table_of(implam, "fields")
    for choice in sorted({row[3] for row in rows} - {"-"}):
        deck = "crack_bands" if choice == "ply_damage" else "damage"  # some fields are of softening plies only
        # Others only with strengths that scatter, or with stringers.
        more = {"ply_damage": SCATTER, "displacement": STRINGER}.get(choice, [])
        history_path = run_deck(implam, write_deck(folder / choice, f"../small/{deck}.nml",
                                                   [f"output%fields='{choice}'", "time%end=20e-6", *more]))
        expected = {name: (place, unit, meaning) for name, place, unit, its_choice, _, meaning in rows
                    if its_choice in ("-", choice)}
        found = fields_of(history_path)
        require(found == expected, f"{choice}: there are {found} and not {expected}.")
    columns = list(read_history(history_path))
    # For the only interface, below ply 2.
    # Columns of lines, stringers and of a filter exist only in decks with these (lines.py, restart_growth.py).
    in_all = [row for row in table_of(implam, "history")
              if not row[0].startswith(("line_", "load_factor", "force_filtered", "far_field_stress",
                                           "shortening", "nominal_strain", "gauge_strain", "stringer_"))]
    expected = [row[0].removesuffix("_N") + "_2" * row[0].endswith("_N") for row in in_all]
    require(columns == expected, f"The columns are {columns} and not {expected}.")
    print(f"{len(rows)} fields and {len(columns)} columns are those of the tables")


def check_columns(implam, folder):
    """The columns of every part of the history have the values of their names."""
    deck_path = write_deck(folder / "columns", "../small/damage.nml", ["output%fields='ply_damage'"])
    history_path = run_deck(implam, deck_path)
    history = {name: np.array(values) for name, values in read_history(history_path).items()}
    deck = read_deck(deck_path)
    energies = sum(history[f"energy_{name}"] for name in (
        "impactor", "kinetic", "strain", "indentation", "delamination", "ply_damage", "contact", "friction",
        "algorithmic"))
    mass, velocity = deck.number("impactor", "mass"), deck.number("impactor", "velocity")
    error = energies - history["work_external"] - mass * velocity**2 / 2
    require(np.max(np.abs(error - history["energy_error"])) < 1e-15, "The energies do not add up to their error.")
    indentation = history["impactor_displacement"] - history["patch_deflection"]
    require(np.allclose(history["indentation"], indentation, rtol=0, atol=1e-12), "The indentation differs.")
    steps = np.diff(history["time"])
    require(np.allclose(steps, history["step_length"][1:], rtol=1e-9), "The length of the step differs.")
    for name in ("iterations", "force_iterations", "contact_iterations"):
        require(np.all(np.cumsum(history[name]) == history[f"total_{name}"]), f"total_{name} is not the sum.")
    grown = history["delaminated_area"] - history["delaminated_area"][0]
    fracture = deck.number("delamination", "G_c") * grown
    require(np.allclose(history["energy_delamination"], fracture, rtol=1e-12) and grown[-1] > 0, "G_c A is missing.")
    released = history["energy_released"][-1] / fracture[-1]
    require(0.5 < released < 1.5, f"{released} of G_c A is released.")
    require(np.all(history["solves"] >= history["total_iterations"]), "There are fewer solves than iterations.")
    require(np.all(history["refactorisations"] <= history["solves"]), "There are more factorizations than solves.")
    results = Results(history_path)
    failures = [results.cells[name].astype(int) for name in results.cells if name.endswith("_failure")]
    for bit, name in ((1, "fibre_failures"), (2, "matrix_cracks"), (4, "matrix_crushings")):
        counted = 4 * sum(np.count_nonzero(failure & bit) for failure in failures)
        require(history[name][-1] == counted, f"{name}: {history[name][-1]}, but {counted} in the fields.")
    print(f"columns: {released:.2f} of G_c A released, {history['matrix_cracks'][-1]:.0f} cracks as in the fields")


def main(implam, folder):
    """Run the trials; the exit code is 1 if one fails."""
    trials = (check_navier, check_damaged_layers, check_energy_release, check_onset, check_opening, check_table,
              check_columns)
    return max(exit_code_of(trial, implam, Path(folder)) for trial in trials)


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
