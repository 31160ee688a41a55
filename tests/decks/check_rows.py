#!/usr/bin/env python3
"""Checks that every group and key of the deck is named only in the folder of its physics.

usage: check_rows.py IMPLAM

Every key that `implam explain` lists has one row, `'GROUP | KEY | ...'`, in one folder of src, and so has every group.
A text that is the name of a key or group, or a list of such names, is only in folders with a row of that name;
elsewhere constants of these folders are used. Names with another meaning are listed below, each with its reason.
"""
import functools
import os
import re
import subprocess
import sys

SRC = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "src")
# Texts that are no names of keys: file, texts, reason. An entry without its text in the file is a breach, too.
OTHERS = (
    ("app/material_explain.f90", "materials", "the list of materials that `implam explain` is asked for"),
    ("report/result_explain.f90", "history", "tables of results that `implam explain` is asked for"),
    ("report/result_rows.f90", "contact_area stress", "columns of the history"),
    ("scales/usual_units.f90", "length time force pressure energy", "kinds of units"),
    ("report/interface_summary.f90", "at energy force", "names in NAME_summary.json"),
    ("app/simulations.f90", "history fields", "items of a checkpoint, which must stay readable"),
    ("app/simulations.f90", "steps", "a timer"),
    ("report/run_warnings.f90", "core indentation steps stringer contact", "warnings"),
    ("report/warning_rows.f90", "core indentation steps stringer contact", "warnings"),
    ("report/summary_file.f90", "angle at plies doubler", "a name in NAME_summary.json"),
    ("case/deck_integrators.f90", "plies", "a part of the model that softens"),
    ("deck/allowed_values.f90", "plies", "a number of values"),
    ("deck/usual_ranges.f90", "density length laminate thickness radius mass velocity time", "quantities"),
    ("report/summary_file.f90", "thickness", "a name in NAME_summary.json"),
    ("scales/unit_systems.f90", "g", "a unit of mass"),
    ("report/summary_file.f90", "case", "a name in NAME_summary.json"),
    ("report/summary_file.f90", "title", "a name in NAME_summary.json"),
    ("report/summary_file.f90", "library", "a name in NAME_summary.json"),
    ("report/mapped_figures.f90", "energy", "a name in NAME_summary.json"),
    ("base/text.f90", "e", "the exponent of a number"),
    ("case/scale_tables.f90", "length mass time force energy pressure", "dimensions"),
    ("case/deck_library.f90", "e", "the exponent of a number"),
    ("case/deck_library.f90", "pressure", "a physical dimension"),
    ("deck/deck_scanner.f90", "end", "&end, which closes a group in old decks"),
    ("deck/allowed_values.f90", "name", "a kind of value"),
    ("deck/deck_values.f90", "name", "a kind of value"),
    ("state/states.f90", "time step iterations", "an item of a checkpoint"),
    ("state/impact_states.f90", "force stress", "an item of a checkpoint"),
    ("interfaces/interface_ties.f90", "zone", "an item of a checkpoint"),
    ("linalg/petsc_session.f90", "petsc_options", "PETSc's own variable of the environment"),
    ("mesh/support_deck.f90", "face", "bearing of the plate, a choice of its bearing"),
    ("impact/indentation_deck.f90", "laminate", "a choice of face"),
    ("case/deck_idle_keys.f90", "yc", "one of the keys of strengths"),
    ("model/load_cases.f90", "time", "the variable of the steps, in messages"),
    ("model/motion_fields.f90", "velocity", "a field in NAME.h5, which users read"),
    ("results/fields_file_xdmf.f90", "cell", "XDMF's word for a field on elements"),
    ("results/output_parameters.f90", "displacement rotation velocity delamination energy_release ply_damage stress",
     "fields, which users choose by these words"),
    ("newton/tangent_operators.f90", "factorization", "a timer"),
)
# The counted noun, as in counted(to_text(n), 'step'), is no key.
NOUN = re.compile(r"(\bcounted\([^']*), '[a-z ]+'\)")
# Kinds of values; rows of the library of materials have a unit in that place.
KIND = re.compile(r"(?:real|integer|logical|text|name|choice|choice or real)$")
# Groups that `implam explain` lists only on request.
HIDDEN = ("controls",)


def explained(program):
    """Every group, and every key with its group, that `implam explain` lists."""
    def ask(*words):
        return subprocess.run([program, "explain", *words], stdout=subprocess.PIPE, timeout=60, check=True,
                              text=True).stdout

    groups = re.findall(r"^  &(\w+)", ask(), re.MULTILINE) + list(HIDDEN)
    keys = [(group, key) for group in groups
            for key in re.findall(r"^  (\w+) .*\n +allowed: ", ask(group), re.MULTILINE)]
    return groups, keys


@functools.cache
def texts(source):
    """The texts in quotes of a Fortran source, with the lines in which they begin; continued ones are joined."""
    found, line, place = [], 1, 0
    while place < len(source):
        mark = source[place]
        if mark == "!":
            place = source.find("\n", place) if "\n" in source[place:] else len(source)
        elif mark in "'\"":
            start, text, place = line, "", place + 1
            while place < len(source) and (source[place] != mark or source[place:place + 2] == 2*mark):
                joint = re.compile(r"&[ ]*\n[ ]*&?").match(source, place)
                if joint:
                    line, place = line + 1, joint.end()
                else:
                    text += source[place]
                    place += 2 if source[place] == mark else 1
            found.append((start, text))
            place += 1
        else:
            line += mark == "\n"
            place += 1
    return found


def breaches(sources, groups, keys):
    """Breaches of the rule: one sentence each."""
    quoted = [(path, line, text) for path, source in sources.items() for line, text in texts(source)]
    rows, owners = {}, {}
    for path, line, text in quoted:
        cells = [cell.strip() for cell in text.split("|")]
        named = {3: cells[:1], 8: cells[:2], 9: cells[:2], 10: cells[:2]}.get(len(cells))
        if len(cells) == 9 and not KIND.match(cells[2]):
            continue
        # A row begins with a name; texts that begin with a bar are parts of other tables.
        if named and named[0]:
            rows.setdefault(tuple(named), []).append(f"{path}:{line}")
            for name in named:
                owners.setdefault(name.lower(), set()).add(path.split("/")[0])
    wanted = [(group,) for group in groups] + keys
    found = [f"&{'%'.join(name)} has {len(rows.get(name, []))} rows: {', '.join(rows.get(name, []))}"
             for name in wanted if len(rows.get(name, [])) != 1]
    found += [f"{places[0]}: `implam explain` does not list the row of &{'%'.join(name)}"
              for name, places in rows.items() if name not in wanted]
    others = {(path, text): reason for path, several, reason in OTHERS for text in several.split()}
    known = set()
    for path, line, text in quoted:
        names = [name.lower() for name in re.split(r"[ ,]+", text)]
        if not all(name in owners for name in names):
            continue
        for name in names:
            if (path, name) in others:
                known.add((path, name))
            elif path.split("/")[0] not in owners[name]:
                found.append(f"src/{path}:{line}: '{text}' is named here, but {name} belongs to "
                             f"{' and '.join(sorted(owners[name]))}")
    return found + [f"src/{path}: no '{text}' is here any more ({reason})"
                    for (path, text), reason in others.items() if (path, text) not in known]


def main():
    sources = {}
    for folder, _, names in os.walk(SRC):
        for name in names:
            if name.lower().endswith(".f90"):
                with open(os.path.join(folder, name), encoding="utf-8") as source:
                    sources[os.path.relpath(os.path.join(folder, name), SRC)] = NOUN.sub(r"\1)", source.read())
    groups, keys = explained(os.path.abspath(sys.argv[1]))
    if not keys:
        sys.exit("`implam explain` lists no keys.")
    found = breaches(sources, groups, keys)
    # The check itself must be able to fail.
    path = "case/deck_reader.f90"
    for spoilt in ("x = 'density'\n", "x = \"Below_Ply\" ! 'it''s'\n", "x = 'E1, &\n  &E2'\n",
                   "'plate | edges |a|b|c|d|e|f'"):
        if len(breaches(dict(sources, **{path: sources[path] + spoilt}), groups, keys)) <= len(found):
            found.append(f"the check does not see {spoilt!r}")
    print("\n".join(found) or f"{len(groups)} groups and {len(keys)} keys are named in their folders alone")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
