"""Ritz's method: a clamped, curved panel of unsymmetric plies under pressure through its snap.
Usage: snap_through.py IMPLAM FOLDER     (ends with 77 where numpy is not installed)

The shallow-shell equations of Marguerre with the shear deformation of first order, for displacements and rotations
that are products of Legendre polynomials and vanish at the edges. The path is followed by the mean deflection, through
the limit pressure. Load steps of Implam jump over the snap: the last pressure before it and the first one behind it
enclose the limit, and the strain energy that the snap releases is algorithmic dissipation. Measured: the limit lies
between these pressures, deflections within .07 % before the snap and .25 % behind it, the energy within .3 %."""

import importlib.util
import shutil
import sys
from pathlib import Path

from solver_runs import DECKS, exit_code_of, read_history, require, run_deck

if importlib.util.find_spec("numpy") is None:
    print("skipped: numpy is not installed")
    raise SystemExit(77)

import numpy as np
from numpy.polynomial import legendre

SIDE, RADIUS, PLY, ANGLES = 150.0, 1200.0, 0.2, (0, 0, 90, 90, 45, -45)
E1, E2, G12, G13, G23, NU12 = 139e3, 9.4e3, 4.5e3, 4.5e3, 2.98e3, 0.309
FULL_LOAD = 0.035
POLYNOMIALS, POINTS = 9, 16
# Mean deflections at which the path is computed.
MEANS = np.concatenate([np.linspace(0.04, 0.4, 13), np.linspace(0.45, 1.1, 14)])
LOW = 0.02
# Relative differences: of the limit pressure beyond the load steps that enclose it, of the deflections at the low and
# the full pressure, of the energy that the snap releases.
LIMIT_ERROR, DEFLECTION_ERROR, ENERGY_ERROR = 0.002, 0.004, 0.01


def stiffness():
    """Return the stiffness of the laminate: membrane, bending, transverse shear."""
    poisson = NU12 * E2 / E1
    reduced = np.array([[E1, NU12 * E2, 0], [NU12 * E2, E2, 0], [0, 0, G12 * (1 - NU12 * poisson)]]) / (
        1 - NU12 * poisson)
    matrix = np.zeros((8, 8))
    heights = PLY * (np.arange(len(ANGLES) + 1) - len(ANGLES) / 2)
    for angle, low, high in zip(np.radians(ANGLES), heights, heights[1:], strict=False):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
        ply = turn.T @ reduced @ turn
        matrix[:6, :6] += np.kron([[high - low, (high**2 - low**2) / 2],
                                   [(high**2 - low**2) / 2, (high**3 - low**3) / 3]], ply)
        shear = np.array([[c, s], [-s, c]])
        matrix[6:, 6:] += 5 / 6 * (high - low) * shear.T @ np.diag([G13, G23]) @ shear
    return matrix


class Panel:
    """The panel in `count`**2 functions for each of u, v, w and the two rotations."""

    def __init__(self, count, points):
        """Integrate the functions."""
        x, weights = legendre.leggauss(points)
        unit = np.eye(count)
        value = np.array([legendre.legval(x, row) for row in unit])
        slope = np.array([legendre.legval(x, legendre.legder(row)) for row in unit])
        value, slope = (1 - x**2) * value, (1 - x**2) * slope - 2 * x * value
        self.weights = np.outer(weights, weights).ravel() * SIDE**2 / 4
        self.n, self.x, self.y = (
            np.einsum("ip,jq->ijpq", one, other).reshape(count**2, -1) * factor
            for one, other, factor in ((value, value, 1), (slope, value, 2 / SIDE), (value, slope, 2 / SIDE)))
        self.w = slice(2 * count**2, 3 * count**2)
        self.matrix = stiffness()
        self.strains = self._strains(count**2, np.repeat(x, points) * SIDE / 2, np.tile(x, points) * SIDE / 2)
        self.load = np.zeros(5 * count**2)
        self.load[self.w] = self.n @ self.weights
        self.centre = np.zeros(5 * count**2)
        middle = [legendre.legval(0.0, row) for row in unit]
        self.centre[self.w] = np.outer(middle, middle).ravel()

    def _strains(self, count, x, y):
        """Return the linear strains of each unknown: membrane, curvatures, shear."""
        strains = np.zeros((8, 5, count, len(self.weights)))
        strains[0, 0], strains[1, 1], strains[2, 0], strains[2, 1] = self.x, self.y, self.y, self.x
        strains[0, 2], strains[1, 2] = self.x * x / RADIUS, self.y * y / RADIUS
        strains[2, 2] = self.y * x / RADIUS + self.x * y / RADIUS
        strains[3, 3], strains[4, 4], strains[5, 3], strains[5, 4] = self.x, self.y, self.y, self.x
        strains[6, 2], strains[6, 3], strains[7, 2], strains[7, 4] = self.x, self.n, self.y, self.n
        return strains.reshape(8, 5 * count, -1)

    def forces(self, state):
        """Return internal forces and tangent stiffness."""
        wx, wy = state[self.w] @ self.x, state[self.w] @ self.y
        strain = np.einsum("idp,d->ip", self.strains, state)
        strain[:3] += [wx**2 / 2, wy**2 / 2, wx * wy]
        varied = self.strains.copy()
        varied[:3, self.w] += [self.x * wx, self.y * wy, self.y * wx + self.x * wy]
        result = self.matrix @ strain * self.weights
        rows = varied.transpose(1, 0, 2).reshape(len(state), -1)
        stiff = (np.tensordot(self.matrix, varied, 1) * self.weights).transpose(1, 0, 2)
        tangent = stiff.reshape(len(state), -1) @ rows.T
        for one, other, force in ((self.x, self.x, 0), (self.y, self.y, 1), (self.x, self.y, 2), (self.y, self.x, 2)):
            tangent[self.w, self.w] += one * result[force] @ other.T
        return rows @ result.ravel(), tangent

    def path(self, means):
        """Return pressure and deflection of the centre at these mean deflections."""
        state, pressure, found = np.zeros(len(self.load)), 0.0, []
        mean = self.load / SIDE**2
        for wanted in means:
            for _ in range(30):
                internal, tangent = self.forces(state)
                steps = np.linalg.solve(tangent, np.column_stack([pressure * self.load - internal, self.load]))
                more = (wanted - mean @ (state + steps[:, 0])) / (mean @ steps[:, 1])
                change = steps[:, 0] + more * steps[:, 1]
                state, pressure = state + change, pressure + more
                if np.abs(change).max() < 1e-8 * np.abs(state).max():
                    break
            else:
                require(False, f"Ritz's method does not converge at a mean deflection of {wanted:g}.")
            found.append((pressure, self.centre @ state))
        return np.array(found).T


def spline(x, y, at):
    """Return values of the polynomial of third order through the four nearest points."""
    near = np.argsort(np.abs(x - at))[:4]
    return np.polyval(np.polyfit(x[near] - at, y[near], 3), 0.0)


def check(implam, folder):
    """Compare both solutions."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(DECKS / "snap_through.nml", folder)
    history = read_history(run_deck(implam, folder / "snap_through.nml"))
    load, deflection = FULL_LOAD * np.array(history["time"]), np.array(history["deflection"])
    jump = int(np.argmax(np.diff(deflection)))
    pressure, centre = Panel(POLYNOMIALS, POINTS).path(MEANS)
    top = next(i for i in range(1, len(pressure) - 1) if pressure[i] > max(pressure[i - 1], pressure[i + 1]))
    fine = np.linspace(MEANS[top - 1], MEANS[top + 1], 201)
    limit = max(spline(MEANS, pressure, mean) for mean in fine)
    low = top + int(np.argmin(pressure[top:]))
    # The energy that the snap releases: pressure times the volume of the jump, less the work along the path.
    every = np.linspace(MEANS[0], MEANS[-1], 4001)
    along = np.array([spline(MEANS, pressure, mean) for mean in every])
    start, end = every[np.argmax(along[every < MEANS[low]])], np.interp(limit, *(
        values[every > MEANS[low]] for values in (along, every)))
    inside = (every >= start) & (every <= end)
    released = SIDE**2 * np.sum(limit - along[inside]) * (every[1] - every[0])
    outside = max(load[jump] - limit, limit - load[jump + 1], 0) / limit
    before = abs(np.interp(LOW, load, deflection) / spline(pressure[:top], centre[:top], LOW) - 1)
    behind = abs(deflection[-1] / spline(pressure[low:], centre[low:], FULL_LOAD) - 1)
    lost = history["energy_algorithmic"][-1] / released - 1
    print(f"limit {limit:.5f} MPa, between {load[jump]:.5f} and {load[jump + 1]:.5f}; deflections differ by "
          f"{100 * before:.2f} % at {LOW:g} MPa, {100 * behind:.2f} % at {FULL_LOAD:g} MPa; energy released "
          f"{released:.2f} mJ, differs by {100 * lost:.2f} %")
    require(deflection[jump + 1] > 3 * deflection[jump], "The panel does not snap.")
    require(outside < LIMIT_ERROR and load[jump + 1] - load[jump] < 0.01 * limit, "The limit pressure differs.")
    require(max(before, behind) < DEFLECTION_ERROR, "The deflections differ.")
    require(abs(lost) < ENERGY_ERROR, "The energy that the snap releases differs.")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(check, Path(sys.argv[1]).resolve(), Path(sys.argv[2])))
