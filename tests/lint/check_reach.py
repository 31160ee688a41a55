"""Checks that every public procedure and type-bound procedure is reached from the main program. Usage:
check_reach.py FOLDER

A name is reached if a reached procedure mentions it. Calls through a variable are resolved by its type; where that
cannot be decided, they reach every binding of that name. So reported names are unused, but not all unused names are
reported. Ends with code 1 if a name is reported or is in EXCEPTIONS without need.
"""

import re
import sys
from pathlib import Path

import check_style
from fortran_units import read_modules

# Names that only tests reach, and why they stay in the program.
EXCEPTIONS: dict[str, str] = {}

NAME = re.compile(r"(?<![\w%])([a-z]\w*)")
UNKNOWN = None
INTRINSIC = ""


def after_brackets(text, start):
    """Position after the brackets that open at a position."""
    depth = 0
    for position in range(start, len(text)):
        depth += (text[position] in "([") - (text[position] in ")]")
        if depth == 0:
            return position + 1
    return len(text)


def chain_at(text, start):
    """Names joined by % from a position on, and the position after them."""
    names = []
    while True:
        found = re.compile(r"\s*([a-z]\w*)\s*").match(text, start)
        if not found:
            return names, start
        names.append(found.group(1))
        start = found.end()
        if text[start : start + 1] == "(":
            start = after_brackets(text, start)
        found = re.compile(r"\s*%").match(text, start)
        if not found:
            return names, start
        start = found.end()


class Walk:
    """Follows names from the main program on."""

    def __init__(self, modules):
        """Start at the main programs."""
        self.modules = modules
        self.types = {}
        for module in modules.values():
            for each in module.types.values():
                self.types.setdefault(each.name, []).append(each)
        self.reached = set()
        self.bindings = set()
        self.waiting = [module.program for module in modules.values() if module.program]
        self.reach_unnamed()
        while self.waiting:
            self.follow(self.waiting.pop())

    def reach_unnamed(self):
        """Reach procedures called without their name: operators, assignments and finalizers."""
        for module in self.modules.values():
            names = [name for name in module.generics if "(" in name]
            names += [name for each in module.types.values() for name in each.finals]
            for procedure in [p for name in names for p in self.exported(module.name, name)]:
                self.reach(procedure)
            for each in module.types.values():
                for name in [name for name in each.generics if "(" in name]:
                    self.call(each, name)

    def reach(self, procedure):
        """Store a procedure."""
        key = (procedure.module, id(procedure))
        if key not in self.reached:
            self.reached.add(key)
            self.waiting.append(procedure)

    def is_reached(self, procedure):
        """Return whether a procedure was stored."""
        return (procedure.module, id(procedure)) in self.reached

    def find(self, name, procedure):
        """Procedures to which a name refers in a procedure: one, those of a generic name, or none."""
        host = procedure
        while host:
            if name in host.inner:
                return [host.inner[name]]
            if name in host.uses:
                return self.exported(*host.uses[name])
            if name in host.types:
                return []
            host = host.host
        module = self.modules[procedure.module]
        if name in module.procedures or name in module.generics:
            return self.exported(module.name, name)
        if name in module.uses:
            return self.exported(*module.uses[name])
        return []

    def exported(self, module, name):
        """Procedures to which a name of a module refers."""
        module = self.modules.get(module)
        if not module:
            return []
        found = [module.procedures[name]] if name in module.procedures else []
        for each in module.generics.get(name, []):
            if each in module.procedures:
                found.append(module.procedures[each])
            elif each in module.uses:
                found += self.exported(*module.uses[each])
        if not found and name in module.uses:
            found = self.exported(*module.uses[name])
        return found

    def type_named(self, name, procedure):
        """Type of a name in a procedure; UNKNOWN if several types have it."""
        if not name:
            return INTRINSIC
        host = procedure
        while host:
            name = host.uses.get(name, (0, name))[1]
            host = host.host
        name = self.modules[procedure.module].uses.get(name, (0, name))[1]
        found = self.types.get(name, [])
        return found[0] if len(found) == 1 else UNKNOWN

    def lineage(self, each):
        """A type and its parents."""
        found = []
        while each:
            found.append(each)
            parents = self.types.get(self.original(each), [])
            each = parents[0] if len(parents) == 1 else None
        return found

    def original(self, each):
        """Name of the type that a type extends, where it is defined."""
        return self.modules[each.module].uses.get(each.parent, (0, each.parent))[1]

    def heirs(self, each):
        """A type and its extensions."""
        return [t for types in self.types.values() for t in types if each in self.lineage(t)]

    def variable(self, name, procedure):
        """Type of a variable."""
        host = procedure
        while host:
            if name in host.types:
                kind = host.types[name]
                return kind if kind is UNKNOWN or not isinstance(kind, str) else self.type_named(kind, host)
            host = host.host
        return UNKNOWN

    def call(self, kind, name):
        """Reach a binding of a type, its overrides and the binding it overrides; return its procedures."""
        targets = []
        for each in {id(t): t for heir in self.heirs(kind) for t in self.lineage(heir)}.values():
            for binding in [name, *each.generics.get(name, [])]:
                if binding not in each.bindings:
                    continue
                self.bindings.add((each.module, each.name, binding))
                if each.bindings[binding]:
                    targets += self.exported(each.module, each.bindings[binding])
        generic = {b for each in self.lineage(kind) for b in each.generics.get(name, [])}
        for binding in generic - {name}:
            targets += self.call(kind, binding)
        for target in targets:
            self.reach(target)
        return targets

    def trace(self, names, procedure):
        """Follow a chain of components and bindings; return the type at its end."""
        kind = self.variable(names[0], procedure)
        if len(names) == 1 and kind is UNKNOWN:
            return self.type_of_result(self.find(names[0], procedure))
        for name in names[1:]:
            if kind is UNKNOWN:
                results = {id(r): r for t in self.all_with(name) for r in self.call(t, name)}
                kind = self.type_of_result(list(results.values()))
                continue
            if kind == INTRINSIC:
                return INTRINSIC
            owner = next((t for t in self.lineage(kind) if name in t.components), None)
            if owner:
                kind = self.type_in_module(owner.components[name], owner.module)
            elif any(name in t.bindings or name in t.generics for t in self.lineage(kind)):
                kind = self.type_of_result(self.call(kind, name))
            else:
                kind = next((t for t in self.lineage(kind) if t.name == name), UNKNOWN)
        return kind

    def type_in_module(self, name, module):
        """Type of a name in a module."""
        if not name:
            return INTRINSIC
        found = self.types.get(self.modules[module].uses.get(name, (0, name))[1], [])
        return found[0] if len(found) == 1 else UNKNOWN

    def all_with(self, name):
        """Types with a binding of this name."""
        return [t for types in self.types.values() for t in types if name in t.bindings or name in t.generics]

    def type_of_result(self, procedures):
        """Type that a function returns; UNKNOWN if it cannot be decided."""
        kinds = [self.variable(p.result, p) if p.result else UNKNOWN for p in procedures]
        return kinds[0] if kinds and all(k is kinds[0] for k in kinds) else UNKNOWN

    def follow(self, procedure):
        """Reach the names that a procedure mentions."""
        names = dict(procedure.types)
        for text in procedure.statements:
            self.enter(text, procedure)
            for found in NAME.finditer(text):
                chain, _ = chain_at(text, found.start())
                if len(chain) > 1:
                    self.trace(chain, procedure)
                for each in self.find(found.group(1), procedure):
                    self.reach(each)
        procedure.types = names

    def enter(self, text, procedure):
        """Give the names of an associate or select type construct their types."""
        if re.match(r"(?:\w+\s*:\s*)?associate\s*\(", text):
            start = text.index("(")
            for part in check_style.split_top(text[start + 1 : after_brackets(text, start) - 1]):
                name, _, expression = part.partition("=>")
                chain, end = chain_at(expression, 0)
                whole = chain and not expression[end:].strip()
                procedure.types[name.strip()] = self.trace(chain, procedure) if whole else UNKNOWN
        elif re.match(r"(?:\w+\s*:\s*)?select\s*type\s*\(", text):
            name = re.match(r"\(\s*(\w+)", text[text.index("(") :]).group(1)
            procedure.types[name] = UNKNOWN


def unreached(modules):
    """Names of public procedures and of bindings that the main program does not reach."""
    walk = Walk(modules)
    names = []
    for module in modules.values():
        for name, procedure in module.procedures.items():
            if name in module.public and not walk.is_reached(procedure):
                names.append(f"{module.name}: {name}")
        for name in module.generics:
            if name in module.public and not any(walk.is_reached(p) for p in walk.exported(module.name, name)):
                names.append(f"{module.name}: {name}")
        for each in module.types.values():
            for name in each.bindings:
                inherited = any(name in t.bindings for t in walk.lineage(each)[1:])
                if not inherited and (module.name, each.name, name) not in walk.bindings:
                    names.append(f"{module.name}: {each.name}%{name}")
    return sorted(names)


def main(arguments, exceptions=EXCEPTIONS):
    """Check a folder; return the exit code."""
    paths = [p for p in sorted(Path(arguments[0]).rglob("*")) if p.name.endswith((".f90", ".F90", ".f90.in"))]
    modules = read_modules(paths)
    names = unreached(modules)
    for name in names:
        if name not in exceptions:
            print(f"{name} is not reached from the main program")
    for name in exceptions:
        if name not in names:
            print(f"{name} is among the exceptions but is reached, or does not exist")
    if set(names) == set(exceptions) and modules:
        print(f"{len(modules)} modules: all that is public is reached but {len(names)} exceptions")
        return 0
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
