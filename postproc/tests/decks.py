"""Decks of the tests: Karas' steel ball on a steel plate, and Sun and Chen's laminate."""

from pathlib import Path

from implam_post.io.deck import Deck

KARAS = """
! Karas: steel ball on a steel plate
&case name='karas' kinematics='linear' /
&plate length=0.2, 0.2  edges='simple' /
&mesh elements=20, 20  patch=5.0d-3 /
&material name='steel' density=7833 E=206.8e9 nu=0.28 /
&laminate materials='steel' angles=0 thicknesses=8e-3 /
&impactor mass=0.0328108 velocity=1 radius=0.01 /
&indentation law='hertz' k=1.49595e10 /
&time end=120e-6 step=1e-6 /
"""

SUN_CHEN = """
&case name='sun_chen' kinematics='linear' /
&plate length=2*0.2 edges=4*'simple' symmetry='quarter' /
&mesh elements=20,20 patch=5e-3 /
&material name='carbon' density=1580 E1=120e9 E2=7.9e9 G12=5.5e9 G23=5.5e9 nu12=0.30 /
&laminate materials='carbon' angles=0,90,0,90,0,0,90,0,90,0 thicknesses=10*0.269e-3 /
&impactor mass=8.537e-3 velocity=3 radius=6.35e-3 /
&indentation law='hertz' k=8.112e8 alpha_cr=80.3e-6 /
&time end=1000e-6 step=1e-6 /
"""


def deck(text: str, *changes: tuple[str, str]) -> Deck:
    """Return a deck with some of its text replaced; every old text must be found."""
    for old, new in changes:
        if old not in text:
            raise ValueError(f"{old!r} is not in the deck")
        text = text.replace(old, new)
    return Deck(text, Path("test.nml"))
