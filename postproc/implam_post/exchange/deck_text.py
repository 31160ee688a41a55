"""Write the deck of an imported panel."""

import textwrap
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from implam_post.exchange.bulk_shape import Shape
from implam_post.exchange.bulk_supports import Supports
from implam_post.exchange.bulk_thermal import Thermal
from implam_post.exchange.stringers import SHEAR_CORRECTION, Stringer
from implam_post.laminate.decks import STRENGTHS
from implam_post.laminate.sections import Material, natural_shear_correction
from implam_post.laminate.zones import Rectangle, Zones

# Minimum of elements along x and y of a patch and of the plate around it (src/case/deck_extents.f90).
_BESIDE_PATCH = 3


class Impact(NamedTuple):
    """Impactor, end of the run and time step; None is left for the user to fill in."""

    mass: float | None = None
    velocity: float | None = None
    radius: float | None = None
    end: float | None = None
    step: float | None = None


def deck_text(name: str, source: str, shape: Shape, supports: Supports, zones: Zones, stringers: Sequence[Stringer],
              impact: Impact, thermal: Thermal | None = None, remarks: Sequence[str] = ()) -> str:
    """Return the deck with `remarks` as comments; groups of the impact are comments unless `impact` gives their values.
    """
    return "\n".join([*_header(source, shape), *(f"! {remark}" for remark in remarks),
                      *_plate(name, shape, supports, impact, bool(zones.doublers or zones.drops or stringers)),
                      *_laminate(zones), *_zones(zones), *_stringers(stringers, shape), *_thermal(thermal),
                      *_impact(impact)]) + "\n"


def number(value: float) -> str:
    """Return the shortest text of a number that keeps all its digits."""
    exact = repr(float(value))
    digits = len(exact.replace("-", "").replace(".", "").partition("e")[0].strip("0"))
    mantissa, _, exponent = f"{value:.{max(digits - 1, 0)}e}".partition("e")
    short = f"{mantissa}e{int(exponent)}"
    plain = exact.removesuffix(".0")
    return plain if 0.01 <= abs(value) < 1e5 or len(plain) <= len(short) else short


def _header(source: str, shape: Shape) -> Iterator[str]:
    """Return the comments on the source of the panel and its axes."""
    axes = [("-" if row.sum() < 0 else "") + "xyz"[abs(row).argmax()] if max(abs(row)) > 1 - 1e-6 else
            "(" + ", ".join(f"{part + 0.0:.6g}" for part in row) + ")" for row in shape.axes]
    origin = ", ".join(f"{place if abs(place) > 1e-9 * max(shape.lengths) else 0:.10g}" for place in shape.origin)
    yield f"! Panel of {source}. Its origin is at ({origin}) of the file;"
    yield f"! x, y and z (from the struck face to the back) are {', '.join(axes)} of the file."


def _plate(name: str, shape: Shape, supports: Supports, impact: Impact, has_lines: bool) -> Iterator[str]:
    """Return the groups of case, plate and mesh; `has_lines` if zones and stringers need lines of the mesh."""
    edges = supports.edges if len(set(supports.edges)) > 1 else supports.edges[:1]
    yield f"&case      name='{name}' /"
    yield (f"&plate     length={', '.join(map(number, shape.lengths))}  edges={', '.join(map(repr, edges))}  "
           f"in_plane='{'fixed' if supports.in_plane_fixed else 'free'}'{_curvature(shape)} /")
    patch = f"  patch={number(impact.radius / 2)}" if impact.radius is not None else ""
    yield from _lines(shape, supports)
    # Zones and stringers need lines that the growth of elements away from a patch would move.
    patch += "  grading=1" if patch and has_lines else ""
    elements = [count + count % 2 for count in shape.finer] if has_lines else shape.elements
    elements = [max(count, _BESIDE_PATCH) for count in elements] if patch else elements
    yield f"&mesh      elements={elements[0]}, {elements[1]}{patch} /"


def _curvature(shape: Shape) -> str:
    """Return the key of the radii of a curved panel."""
    if not any(shape.surface.curvatures):
        return ""
    return "  curvature_radius=" + ", ".join(number(float(f"{1 / curvature:.7g}")) if curvature else "0"
                                             for curvature in shape.surface.curvatures)


def _lines(shape: Shape, supports: Supports) -> Iterator[str]:
    """Return the groups &line that constrain in-plane displacements of edges, one component each."""
    for edge, component in supports.in_plane_lines:
        axis, far = divmod(edge, 2)
        at = number((1 if far else -1) * shape.lengths[axis] / 2)
        yield (f"&line      at={at}  direction='{'yx'[axis]}'  component='{' uv'[component]}'  displacement=0  "
               "history='fixed' /")


def _laminate(zones: Zones) -> Iterator[str]:
    """Return the materials and the plies of the laminate."""
    plies = zones.laminate
    materials = {ply.material.name: ply.material for ply in zones.plies}
    for material in materials.values():
        yield from _wrapped("&material  ", " ".join(_constants(material)))
    lists = {"materials": [repr(ply.material.name) for ply in plies], "angles": [number(ply.angle) for ply in plies],
             "thicknesses": [number(ply.thickness) for ply in plies]}
    texts = [f"{key}={', '.join(values[:1] if key != 'angles' and len(set(values)) == 1 else values)}"
             for key, values in lists.items()]
    correction = natural_shear_correction(plies)
    if correction != "5/6":
        texts.append(f"shear_correction='{correction}'")
    yield from _wrapped("&laminate  ", "  ".join(texts))


def _zones(zones: Zones) -> Iterator[str]:
    """Return doublers and ply drops."""
    for doubler in zones.doublers:
        names = [repr(ply.material.name) for ply in doubler.plies]
        yield from _wrapped("&doubler   ", "  ".join((
            f"name='{doubler.name}'", f"face='{doubler.face}'", *_area(doubler.area),
            f"materials={', '.join(names[:1] if len(set(names)) == 1 else names)}",
            f"stacking='[{'/'.join(number(ply.angle) for ply in doubler.plies)}]'",
            f"ply_thickness={number(doubler.plies[0].thickness)}")))
    for drop in zones.drops:
        yield from _wrapped("&ply_drop  ", "  ".join((f"plies={', '.join(map(str, drop.missing))}", *_area(drop.area),
                                                      f"flat_face='{drop.flat_face}'")))


def _area(area: Rectangle) -> Iterator[str]:
    """Return the keys of a rectangle."""
    yield from (f"{key}={', '.join(map(number, values))}" for key, values in zip(("at", "size"), area, strict=True))


def _stringers(stringers: Sequence[Stringer], shape: Shape) -> Iterator[str]:
    """Return the stringers: blades and T by sizes, others by their stiffness."""
    for stringer in stringers:
        section, half = stringer.section, shape.lengths[stringer.axis] / 2
        keys = {"name": f"'{stringer.name}'", "along": f"'{'xy'[stringer.axis]}'", "at": number(stringer.at)}
        if max(abs(stringer.ends[0] + half), abs(stringer.ends[1] - half)) > 1e-6 * half:
            keys |= {"from": number(stringer.ends[0]), "to": number(stringer.ends[1])}
        keys["face"] = f"'{stringer.face}'"
        if section.web is not None:
            keys["section"] = "'T'" if section.cap else "'blade'"
            values = dict(zip(("height", "thickness", "cap_width", "cap_thickness"), section.web + (section.cap or ()),
                              strict=False)) | {"E": section.modulus, "G": section.shear_modulus,
                                                "density": section.density}
        else:
            # The solver takes the shear stiffness as 5/6 of EA G/E.
            shear = section.shear_modulus * section.shear_area / (SHEAR_CORRECTION * section.area)
            keys["section"] = "'given'"
            values = {"EA": section.modulus * section.area, "EI": section.modulus * section.bending,
                      "EI_lateral": section.modulus * section.lateral, "GJ": section.shear_modulus * section.torsion,
                      "mass_per_length": section.mass, "eccentricity": section.eccentricity, "E": section.modulus,
                      "G": shear}
        keys |= {key: number(float(f"{value:.9g}")) for key, value in values.items() if value > 0}
        yield from _wrapped("&stringer  ", "  ".join(f"{key}={value}" for key, value in keys.items()))


def _constants(material: Material) -> Iterator[str]:
    """Return the keys of a material."""
    yield f"name='{material.name}'"
    if material.density > 0:
        yield f"density={number(material.density)}"
    constants = ({"E": material.e1, "nu": material.nu12} if material.isotropic else
                 {"E1": material.e1, "E2": material.e2, "G12": material.g12, "G13": material.g13, "G23": material.g23,
                  "nu12": material.nu12})
    strengths = dict(material.strengths)
    yield from (f"{key}={number(value)}" for key, value in constants.items())
    yield from (f"{key}={number(strengths[key])}" for key in STRENGTHS if key in strengths)
    if any(material.expansion):
        yield from (f"alpha{axis}={number(value)}" for axis, value in enumerate(material.expansion, 1))


def _wrapped(head: str, text: str) -> list[str]:
    """Return a group within the width of a line."""
    # A non-breaking space keeps the closing slash on the line of the last key.
    lines = textwrap.wrap(f"{head}{text}\u00a0/", 110, subsequent_indent=len(head) * " ", break_long_words=False,
                          break_on_hyphens=False)
    return [line.replace("\u00a0", " ") for line in lines]


def _thermal(thermal: Thermal | None) -> Iterator[str]:
    """Return the group of the temperature, or a comment on how to fill it in."""
    if thermal is None:
        return
    if thermal.change is not None:
        yield f"&thermal   delta_T={number(thermal.change)} /"
    elif thermal.reference is not None:
        yield f"! Stress-free at TREF = {number(thermal.reference)}: &thermal  delta_T=  (temperature minus TREF) /"
    else:
        yield "! alpha1 and alpha2 are used with &thermal  delta_T= /"


def _impact(impact: Impact) -> Iterator[str]:
    """Return the groups of the impact."""
    if impact.radius is None:
        yield from ("! For an impact, fill in the values and uncomment; &mesh then needs patch=, the side of the",
                    "! loaded square, about half the radius.", "! &impactor    mass=  velocity=  radius= /")
    else:
        yield (f"&impactor  mass={number(impact.mass)}  velocity={number(impact.velocity)}  "
               f"radius={number(impact.radius)} /")
    yield "! Without it the contact is elastic: &indentation  alpha_cr= /"
    if impact.end is None or impact.step is None:
        yield "! &time        end=  step= /"
    else:
        yield f"&time      end={number(impact.end)}  step={number(impact.step)} /"
    yield "! For damage: &delamination, and &ply_damage, which needs XT, YT, YC, S12, Sf and Sm23 of every &material."
