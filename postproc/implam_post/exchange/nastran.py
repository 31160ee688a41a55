"""A panel as Nastran bulk data, with the executive and case control of a static analysis."""

import re
from collections.abc import Iterator, Sequence

from implam_post.exchange.panel import MaterialState, Panel, Section
from implam_post.exchange.shell_mesh import ShellMesh, shell_mesh
from implam_post.exchange.stringer_lines import line_of
from implam_post.exchange.stringers import SHEAR_CORRECTION, Stringer
from implam_post.laminate.sections import Material

Field = int | float | str | None
_SUPPORTS, _LOAD, _TEMPERATURE = 1, 1, 2
# Fields of MAT8 and MAT1 for strengths of the deck.
_MAT8_STRENGTHS = ("XT", "XC", "YT", "YC", "S12")
_MAT1_STRENGTHS = ("XT", "XC", "S12")


def nastran_deck(panel: Panel, source: str, with_z0: bool = False) -> Iterator[str]:
    """Return the lines: four CQUAD4 per cell, a PCOMP for each section, MAT8 or MAT1, SPC1, and PLOAD2 for a pressure;
    two CBAR with offsets per side of a cell under a stringer, with PBARL for a blade and PBAR for other sections.

    Stacks away from the mid-plane have ZOFFS on their elements, or Z0 on their PCOMP.
    """
    mesh, sections = shell_mesh(panel, with_middles=True), panel.sections()
    yield from (f"$ {panel.name}: panel from {source}", "$ z points from the struck face to the back; the first ply of "
                "each PCOMP is the one", "$ nearest to the struck face.", *(f"$ {note}." for note in panel.unwritten),
                "SOL 101", "CEND", f"TITLE = {panel.name}",
                f"SPC = {_SUPPORTS}")
    if panel.pressure is not None:
        yield f"LOAD = {_LOAD}"
    if panel.expands:
        yield f"TEMPERATURE(LOAD) = {_TEMPERATURE}"
    yield from ("DISPLACEMENT = ALL", "BEGIN BULK")
    for grid, place in enumerate(mesh.coordinates, 1):
        yield from card("GRID", grid, None, *map(float, place))
    yield from _elements(panel, mesh, sections, with_z0)
    numbers = {state: number for number, state in enumerate(panel.materials(), 1)}
    for number, section in enumerate(sections, 1):
        yield from _property(number, section, numbers, with_z0, 0.0 if panel.expands else None)
    for state, material in panel.materials().items():
        yield from _material(numbers[state], state, material)
    for number, stringer in enumerate(panel.stringers, 1):
        yield from _stringer(panel, mesh, stringer, len(sections) + number, len(numbers) + number)
    yield from _supports(panel, mesh)
    if panel.pressure is not None:
        yield from card("PLOAD2", _LOAD, panel.pressure, 1, "THRU", 4 * mesh.struck)
    if panel.expands:
        yield from card("TEMPD", _TEMPERATURE, panel.temperature)
    yield "ENDDATA"


def _elements(panel: Panel, mesh: ShellMesh, sections: Sequence[Section], with_z0: bool) -> Iterator[str]:
    """Return the elements; their material axis is x of the basic system."""
    properties = {section: number for number, section in enumerate(sections, 1)}
    number = 0
    for element in mesh.elements:
        section = panel.section(element.stack)
        offset = None if with_z0 else section.middle or None
        for corners in element.quarters:
            number += 1
            yield from card("CQUAD4", number, properties[section], *corners, 0, offset)


def _property(number: int, section: Section, materials: dict[MaterialState, int], with_z0: bool,
              reference: float | None) -> Iterator[str]:
    """Return a PCOMP about its own mid-plane, or with the z of its bottom surface if `with_z0`; `reference` is TREF."""
    yield f"$ {section.title}"
    plies = [field for layer in section.layers
             for field in (materials[layer.material], layer.thickness, layer.angle, "YES")]
    face = section.first_face if with_z0 and section.middle else None
    yield from card("PCOMP", number, face, None, None, None, reference, None, None, *plies)


def _material(number: int, state: MaterialState, material: Material) -> Iterator[str]:
    """Return a MAT8, or a MAT1 of an undamaged material with E and nu; strengths are written if it is undamaged."""
    yield f"$ {state.name} {state.failed}".rstrip()
    strengths = dict(material.strengths)
    along, across = material.expansion
    is_mat1 = material.isotropic and along == across
    fields = _MAT1_STRENGTHS if is_mat1 else _MAT8_STRENGTHS
    yield from (f"$ {key} = {value!r} has no field" for key, value in strengths.items() if key not in fields)
    limits = [strengths.get(key) for key in fields]
    density = material.density or None
    if is_mat1:
        yield from card("MAT1", number, material.e1, None, material.nu12, density, along or None, None, None, *limits)
        return
    expansion = (along, across) if along or across else (None, None)
    yield from card("MAT8", number, material.e1, material.e2, material.nu12, material.g12, material.g13, material.g23,
                    density, *expansion, None, *limits)


def _stringer(panel: Panel, mesh: ShellMesh, stringer: Stringer, number: int, material: int) -> Iterator[str]:
    """Return material, property and elements of a stringer; `number` is that of the property.

    The plane 1 of the elements is normal to the panel; offsets are those of the centroid from the grids.
    """
    section, sides = stringer.section, line_of(panel, mesh, stringer)
    yield f"$ stringer {stringer.name}"
    yield from card("MAT1", material, section.modulus, section.shear_modulus, None, section.density or None)
    if section.web is not None and section.cap is None:
        yield from card("PBARL", number, material, None, "BAR", None, None, None, None, section.web[1], section.web[0])
    else:
        factor = section.shear_area / section.area
        extra = None if section.density else section.mass or None
        yield from card("PBAR", number, material, section.area, section.bending, section.lateral, section.torsion,
                        extra, None, *8 * (None,), factor, SHEAR_CORRECTION)
    first = 4 * len(mesh.elements) + 1 + sum(2 * len(line_of(panel, mesh, other)) for other in panel.stringers[
        :panel.stringers.index(stringer)])
    halves = [half for side in sides for half in (side[:2], side[1:])]
    for element, (start, end) in enumerate(halves, first):
        outwards = stringer.outwards * (start.normal + end.normal) / 2
        offsets = [float(f"{place:.12g}") + 0.0 for point in (start, end)
                   for place in (point.face + stringer.outwards * section.eccentricity) * point.normal]
        direction = [float(f"{each:.6g}") + 0.0 for each in outwards]
        yield from card("CBAR", element, number, start.grid, end.grid, *direction, None, None, None, *offsets)


def _supports(panel: Panel, mesh: ShellMesh) -> Iterator[str]:
    """Return the supports; they include the rotation about the normal, which has no stiffness in a flat panel.

    At stringers it is free: their sections turn with the line of the centroid as the panel twists.
    """
    for components, grids in mesh.supports.items():
        yield from card("SPC1", _SUPPORTS, int(components), *grids)
    turning = {point.grid for stringer in panel.stringers for side in line_of(panel, mesh, stringer) for point in side}
    start = 1
    for grid in (*sorted(turning), len(mesh.coordinates) + 1):
        if grid - start > 1:
            yield from card("SPC1", _SUPPORTS, 6, start, "THRU", grid - 1)
        elif grid > start:
            yield from card("SPC1", _SUPPORTS, 6, start)
        start = grid + 1


def card(name: str, *fields: Field) -> Iterator[str]:
    """Return a card in small fields, or in large fields if a number needs them to keep its digits."""
    while fields and fields[-1] is None:
        fields = fields[:-1]
    small = all(not isinstance(field, float) or same(field, 8) for field in fields)
    width, count = (8, 8) if small else (16, 4)
    texts = ["" if field is None else real(field, width) if isinstance(field, float) else str(field)
             for field in fields]
    # Lines of large fields come in pairs.
    texts += ([] if small else -len(texts) % 8 * [""])
    head = name if small else name + "*"
    for start in range(0, len(texts), count):
        yield (head.ljust(8) + "".join(text.ljust(width) for text in texts[start:start + count])).rstrip()
        head = "+" if small else "*"


def same(number: float, width: int) -> bool:
    """Return whether a field of `width` characters keeps all digits of a number."""
    mantissa, sign, exponent = re.fullmatch(r"(-?[0-9.]+)([+-]?)([0-9]*)", real(number, width)).groups()
    return float(f"{mantissa}e{sign}{exponent or 0}") == number


def real(number: float, width: int) -> str:
    """Return a real number in at most `width` characters, all its digits if they fit."""
    shortest = repr(number)
    for text in (shortest, *(f"{number:.{digits}e}" for digits in range(width, -1, -1))):
        mantissa, _, exponent = text.partition("e")
        mantissa = mantissa if "." in mantissa else mantissa + "."
        integer, _, fraction = mantissa.partition(".")
        fraction = fraction if text is shortest and not exponent else fraction.rstrip("0")
        written = f"{integer}.{fraction}" + (f"{int(exponent):+d}" if exponent else "")
        if len(written) <= width:
            return written
    raise ValueError(f"{number} does not fit into {width} characters")
