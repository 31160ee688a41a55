"""A panel as an Abaqus input file, with keywords that CalculiX reads too."""

import re
from collections.abc import Iterator, Sequence

from implam_post.exchange.nastran import real
from implam_post.exchange.panel import MaterialState, Panel, Section
from implam_post.exchange.shell_mesh import ShellMesh, shell_mesh
from implam_post.exchange.stringers import Stringer
from implam_post.exchange.webs import Webs, rows_of, webs_of
from implam_post.laminate.sections import Material, direction


def abaqus_input(panel: Panel, source: str) -> Iterator[str]:
    """Return the lines of the input: shells S8R with composite sections, also for webs and caps of stringers, and a
    static step under the pressure.
    """
    mesh, sections = shell_mesh(panel, with_middles=False), panel.sections()
    webs = webs_of(panel, mesh)
    yield from (f"** {panel.name}: panel from {source}", "** z points from the struck face to the back; the first "
                "layer of each section is the one nearest to the struck face.",
                *(f"** {note}." for note in (*panel.unwritten, *unwritten_stringers(panel))), "*HEADING", panel.name)
    yield "*NODE, NSET=PANEL"
    yield from (f"{number}, {x:.12g}, {y:.12g}, {real(float(z), 20)}"
                for number, (x, y, z) in enumerate(mesh.coordinates, 1))
    yield from _elements(panel, mesh, sections)
    yield from _webs(panel, webs, len(mesh.elements) + 1)
    names = {state: _material_name(number, state) for number, state in enumerate(panel.materials(), 1)}
    for state, material in panel.materials().items():
        yield from _material(names[state], state, material)
    for angle in sorted({layer.angle for section in sections for layer in section.layers}):
        yield from _orientation(angle)
    for number, section in enumerate(sections, 1):
        yield from _section(number, section, names)
    for components, grids in mesh.supports.items():
        yield f"*NSET, NSET=HELD_{components}"
        yield from _rows(grids)
    yield "*BOUNDARY"
    yield from (f"HELD_{components}, {component}, {component}" for components in mesh.supports
                for component in components)
    yield from (f"{node}, {component}, {component}" for node, component in webs.fixed)
    for node, other, component in webs.equal:
        yield from ("*EQUATION", "2", f"{node}, {component}, 1., {other}, {component}, -1.")
    if panel.expands:
        yield from ("*INITIAL CONDITIONS, TYPE=TEMPERATURE", "PANEL, 0.")
    if panel.pressure is not None or panel.expands:
        yield from _step(panel.pressure, panel.temperature if panel.expands else None, mesh)


def _elements(panel: Panel, mesh: ShellMesh, sections: Sequence[Section]) -> Iterator[str]:
    """Return the elements, with an element set for each section."""
    members: dict[Section, list[int]] = {section: [] for section in sections}
    yield "*ELEMENT, TYPE=S8R, ELSET=ALL_SHELLS"
    for number, element in enumerate(mesh.elements, 1):
        yield ", ".join(map(str, [number, *element.eight]))
        members[panel.section(element.stack)].append(number)
    for place, section in enumerate(sections, 1):
        yield f"*ELSET, ELSET=SECTION_{place}"
        yield from _rows(members[section])


def unwritten_stringers(panel: Panel) -> list[str]:
    """Return notes on stringers that are not written, as their section has no sizes."""
    return [f"the stringer '{stringer.name}' is not written, as its section has no sizes: add a beam"
            for stringer in panel.stringers if stringer.section.web is None]


def _webs(panel: Panel, webs: Webs, first: int) -> Iterator[str]:
    """Return nodes, elements, materials and sections of the stringers."""
    if not webs.nodes:
        return
    yield "*NODE, NSET=WEBS"
    yield from (f"{number}, " + ", ".join(f"{place + 0.0:.12g}" for place in position)
                for number, position in webs.nodes.items())
    for (number, part), elements in rows_of(webs, first):
        stringer = panel.stringers[number]
        name = f"{part}_{number + 1}"
        yield from (f"** stringer {stringer.name}", f"*ELEMENT, TYPE=S8R, ELSET={name}")
        yield from (", ".join(map(str, [element, *nodes])) for element, nodes in elements)
        yield from _shell_of_stringer(stringer, number + 1, part, name)


def _shell_of_stringer(stringer: Stringer, number: int, part: str, name: str) -> Iterator[str]:
    """Return the section of a web or cap, and the material with the first of them."""
    section = stringer.section
    if part == "WEB":
        ratio = section.modulus / (2 * section.shear_modulus) - 1
        ratio = ratio if 0 <= ratio < 0.5 else 0.0
        shear = f"{section.shear_modulus:.12g}"
        yield from (f"*MATERIAL, NAME=STRINGER_{number}", "*ELASTIC, TYPE=ENGINEERING CONSTANTS",
                    ", ".join([*3 * [f"{section.modulus:.12g}"], f"{ratio:.12g}", "0", "0", shear, shear]), shear)
        if section.density:
            yield from ("*DENSITY", f"{section.density:.12g}")
        thickness = section.web[1]
    else:
        thickness = section.cap[1]
    along = ("1, 0, 0", "0, 1, 0")[stringer.axis]
    second = {"WEB": "0, 0, 1", "CAP": ("0, 1, 0", "-1, 0, 0")[stringer.axis]}[part]
    yield from (f"*ORIENTATION, NAME=ALONG_{name}", f"{along}, {second}",
                f"*SHELL SECTION, ELSET={name}, MATERIAL=STRINGER_{number}, ORIENTATION=ALONG_{name}",
                f"{thickness:.12g}")


def _material_name(number: int, state: MaterialState) -> str:
    """Return a name that is unique by its number, since names in Abaqus are short and not case-sensitive."""
    return f"M{number}_" + re.sub("[^A-Z0-9]", "_", state.name.upper())[:60]


def _material(name: str, state: MaterialState, material: Material) -> Iterator[str]:
    """Return the elastic constants; nu13 and nu23, which plane stress does not use, are zero."""
    yield from (f"** {state.name} {state.failed}".rstrip(), f"*MATERIAL, NAME={name}",
                "*ELASTIC, TYPE=ENGINEERING CONSTANTS")
    constants = [material.e1, material.e2, material.e2, material.nu12, 0.0, 0.0, material.g12, material.g13]
    yield ", ".join(f"{value:.12g}" for value in constants)
    yield f"{material.g23:.12g}"
    if any(material.expansion):
        along, across = material.expansion
        yield from ("*EXPANSION, TYPE=ORTHO", f"{along:.12g}, {across:.12g}, {across:.12g}")
    if material.density > 0:
        yield from ("*DENSITY", f"{material.density:.12g}")
    yield from (f"** {key} = {value!r} has no keyword" for key, value in material.strengths)


def _orientation_name(angle: float) -> str:
    """Return the name of the orientation at an angle."""
    return "AT_" + f"{angle + 0.0:g}".replace("-", "MINUS_").replace(".", "_")


def _orientation(angle: float) -> Iterator[str]:
    """Return the orientation of plies at an angle from x; the last line gives the axis along the normal."""
    c, s = direction(angle)
    yield f"*ORIENTATION, NAME={_orientation_name(angle)}"
    yield ", ".join(f"{value + 0.0:.12g}" for value in (c, s, 0.0, -s, c, 0.0))
    yield "3, 0."


def _section(number: int, section: Section, names: dict[MaterialState, str]) -> Iterator[str]:
    """Return a composite section; OFFSET is the distance of the nodes from its mid-plane over its thickness."""
    offset = f", OFFSET={-section.middle / section.thickness:.12g}" if section.middle else ""
    yield f"** {section.title}"
    yield f"*SHELL SECTION, ELSET=SECTION_{number}, COMPOSITE{offset}"
    yield from (f"{layer.thickness:.12g}, 3, {names[layer.material]}, {_orientation_name(layer.angle)}"
                for layer in section.layers)


def _step(pressure: float | None, temperature: float | None, mesh: ShellMesh) -> Iterator[str]:
    """Return a static step and the displacements: pressure on the struck face, positive towards the back, temperature.
    """
    yield from ("*ELSET, ELSET=STRUCK, GENERATE", f"1, {mesh.struck}, 1", "*STEP", "*STATIC")
    if pressure is not None:
        yield from ("*DLOAD", f"STRUCK, P, {pressure:.12g}")
    if temperature is not None:
        yield from ("*TEMPERATURE", f"PANEL, {temperature:.12g}")
    yield from ("*NODE PRINT, NSET=PANEL", "U", "*NODE FILE", "U", "*END STEP")


def _rows(numbers: Sequence[int]) -> Iterator[str]:
    """Return numbers, sixteen per line."""
    for start in range(0, len(numbers), 16):
        yield ", ".join(map(str, numbers[start:start + 16]))
