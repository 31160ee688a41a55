#!/usr/bin/env python3
"""Which yield pressure the measured dents ask for, and which the conditions for a crushed matrix give.

Thornton's law (doc/theory/impact.md, F7) leaves a dent that depends on the largest force, the nose, the modulus
through the thickness and the yield pressure. Forces are those measured or, for T800S/3900-2B, computed by its deck.
Conditions, all with the in-plane strains held (F9): Hashin's (F10), which the program has; Tresca's; friction on the
fracture plane after Davila et al. (2005), the matrix criterion of criteria='larc'; and Hashin's with the pressure of
full plasticity, 2.8 over 1.6 times that of first yield (K. L. Johnson, Contact Mechanics, 1985, section 6.3)."""

from math import cos, pi, radians, sin, sqrt, tan

ANGLE = 53  # degrees, fracture plane under compression across the fibres
PANELS = {  # force, nose radius, E1, E2, nu12, nu23, YC, measured dent; SI
    "T700/M21, 25 J": (8.68e3, 8e-3, 130e9, 7.7e9, 0.30, 0.35, 290e6, 0.50e-3),
    "T800S/3900-2B, 15.5 J": (10.5e3, 8e-3, 150e9, 8.8e9, 0.35, 0.40, 250e6, 0.18e-3),
    "the same, nose of 20 mm": (10.5e3, 10e-3, 150e9, 8.8e9, 0.35, 0.40, 250e6, 0.18e-3),
    "the same, YC of T700/M21": (10.5e3, 8e-3, 150e9, 8.8e9, 0.35, 0.40, 290e6, 0.18e-3),
    "IM7/8552, 27 J": (11e3, 8e-3, 171.4e9, 9.08e9, 0.32, 0.52, 199.8e6, None)}


def dent(force, radius, modulus, pressure):
    """Return the dent after a largest force."""
    stiffness = 4 / 3 * sqrt(radius) * modulus
    critical = (2 * pi * radius * pressure / (3 * stiffness))**2
    if force < stiffness * critical**1.5:
        return 0.0
    largest = critical + (force - stiffness * critical**1.5) / (1.5 * stiffness * sqrt(critical))
    return largest - force / (stiffness * sqrt(largest))


def pressure_of(measured, *contact):
    """Return the yield pressure that leaves a measured dent."""
    low, high = 50e6, 8e9
    for _ in range(60):
        low, high = ((low + high) / 2, high) if dent(*contact, (low + high) / 2) > measured else (low, (low + high) / 2)
    return low


def conditions(along, across, major, transverse, strength):
    """Return the modulus through the thickness, and the yield pressure of each condition."""
    part = major**2 * across / along
    modulus = across * (1 - part) / ((1 + transverse) * (1 - transverse - 2 * part))
    ratio = (transverse + part) / (1 - part)
    a = radians(ANGLE)
    shear, friction = strength * cos(a) * (sin(a) + cos(a) / tan(2 * a)), -1 / tan(2 * a)
    square = ((1 - ratio) / (2 * shear))**2
    linear = ((strength / (2 * shear))**2 - 1) * (1 + ratio) / strength
    hashin = (linear + sqrt(linear**2 + 4 * square)) / (2 * square)
    planes = [radians(degrees / 10) for degrees in range(1, 900)]
    largest = max((1 - ratio) * sin(x) * cos(x) - friction * (cos(x)**2 + ratio * sin(x)**2) for x in planes)
    return modulus, {"Hashin": hashin, "Tresca": strength / (1 - ratio), "friction": shear / max(largest, 1e-9),
                     "Hashin, fully plastic": hashin * 2.8 / 1.6}


def main():
    """Print a table."""
    for name, (force, radius, *constants, measured) in PANELS.items():
        modulus, pressures = conditions(*constants)
        strength = constants[-1]
        print(f"{name}: force {force / 1e3:.2f} kN, E3 {modulus / 1e9:.2f} GPa")
        if measured:
            needed = pressure_of(measured, force, radius, modulus)
            print(f"  measured {1e3 * measured:.2f} mm: {needed / 1e6:.0f} MPa, {needed / strength:.2f} YC")
        for condition, pressure in pressures.items():
            print(f"  {condition}: {pressure / 1e6:.0f} MPa, {pressure / strength:.2f} YC, "
                  f"dent {1e3 * dent(force, radius, modulus, pressure):.2f} mm")


if __name__ == "__main__":
    main()
