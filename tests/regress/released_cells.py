"""The cells that a run has delaminated and the plies that have failed, from its fields. Needs h5py."""

import h5py
import numpy as np

CORNERS = 4  # the first nodes of an element in the file
PLACE = 1e-9  # lengths that are distinguished
DIGITS = 5  # of the delaminated fraction of a cohesive cell


def fields_of(history_path):
    """Return the path of the fields beside a history."""
    return history_path.with_name(history_path.name.removesuffix("_history.csv") + ".h5")


def fields_of_times(history_path, words):
    """Return for each written time a dictionary by names with one of the endings, and by positions."""
    found = []
    with h5py.File(fields_of(history_path)) as file:
        for key in sorted(file["times"]):
            time = file["times"][key]
            mesh = file[f"meshes/{int(time['mesh'][()]):08d}"]
            corners = mesh["coordinates"][()][mesh["connectivity"][()][:, :CORNERS], :2]
            places = np.rint(corners.mean(axis=1) / PLACE).astype(int)
            layers = mesh["cells/first_ply"][()].ravel()
            values = {}
            for name, item in time.get("cells", {}).items():
                if name.endswith(words):
                    values |= {(name, int(layer), int(x), int(y)): float(value) for layer, (x, y), value
                               in zip(layers, places, item[()].ravel().round(DIGITS), strict=True) if value != 0}
            found.append(values)
    return found


def released_cells(history_path):
    """Return for each written time the set of delaminated cells, as (first ply below, x, y)."""
    return [{key[1:] for key in values} for values in fields_of_times(history_path, ("delaminated_above",))]


def damage_of(history_path):
    """Return delaminated cells and failed plies at the last written time, by name, layer and position."""
    return fields_of_times(history_path, ("delaminated_above", "_failure"))[-1]


def mirrored(damage):
    """Return the damage mirrored at the line x = y."""
    return {(name, layer, y, x): value for (name, layer, x, y), value in damage.items()}


def folded(damage, part="quarter"):
    """Return the damage of a full plate as that of a part of it; None if the parts differ."""
    parts = {}
    for (name, layer, x, y), value in damage.items():
        left, below = x < 0 and part != "half_y", y < 0 and part in ("quarter", "half_y")
        turned = left and part == "point"
        place = (-x if left else x, -y if below or turned else y)
        parts.setdefault((left, below), {})[name, layer, *place] = value
    first, *others = parts.values() or [{}]
    same = len(others) == (3 if part == "quarter" else 1) and all(other == first for other in others)
    return first if same else {}


def min_releases(before, after):
    """Return a lower bound of the number of successive releases: each one delaminates neighbours of delaminated
    cells."""
    columns = {x: i for i, x in enumerate(sorted({cell[1] for cell in after}))}
    rows = {y: j for j, y in enumerate(sorted({cell[2] for cell in after}))}
    apart = {(layer, columns[x], rows[y]) for layer, x, y in before}
    missing = {(layer, columns[x], rows[y]) for layer, x, y in after} - apart
    releases = 0
    while missing:
        reached = {(layer, i, j) for layer, i, j in missing
                   if apart & {(layer, i + 1, j), (layer, i - 1, j), (layer, i, j + 1), (layer, i, j - 1)}}
        if not reached:
            return 0  # delaminated without a delaminated neighbour: no count
        apart |= reached
        missing -= reached
        releases += 1
    return releases
