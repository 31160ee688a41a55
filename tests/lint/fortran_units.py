"""Contents of the modules of Fortran sources: procedures, types with their bindings, generic names and used modules."""

import re
from dataclasses import dataclass, field

import check_style

BINDING = re.compile(r"procedure\s*(\(\s*\w+\s*\))?([^:]*)::(.*)$|procedure\s+(\w.*)$")
GENERIC = re.compile(r"generic\b[^:]*::\s*([^=]+?)\s*=>\s*(.*)$")
TYPE_HEAD = re.compile(r"type(?!\s*\()((?:\s*,[^:]*)?)\s*(?:::)?\s*(\w+)$")
USE = re.compile(r"use\b\s*(?:,\s*\w+\s*::)?\s*(\w+)\s*(?:,\s*only\s*:\s*(.*)|,\s*(.*))?$")
OF_TYPE = re.compile(r"(?:type|class)\s*\(\s*([\w*]+)\s*\)")
END_OF_UNIT = re.compile(r"end\s*(subroutine|function|procedure|program|module)\b|end$")
RESULT = re.compile(r"result\s*\(\s*(\w+)\s*\)")


@dataclass
class Procedure:
    """A procedure, or the main program; without statements: one of another language."""

    name: str
    module: str
    host: "Procedure | None" = None
    uses: dict = field(default_factory=dict)
    types: dict = field(default_factory=dict)
    statements: list = field(default_factory=list)
    inner: dict = field(default_factory=dict)
    result: str = ""


@dataclass
class Type:
    """A derived type: types of its components ('' if intrinsic), targets of its bindings, generic bindings."""

    name: str
    module: str
    parent: str = ""
    components: dict = field(default_factory=dict)
    bindings: dict = field(default_factory=dict)
    generics: dict = field(default_factory=dict)
    finals: list = field(default_factory=list)


@dataclass
class Module:
    """A module or the main program."""

    name: str
    uses: dict = field(default_factory=dict)
    public: set = field(default_factory=set)
    procedures: dict = field(default_factory=dict)
    types: dict = field(default_factory=dict)
    generics: dict = field(default_factory=dict)
    program: Procedure | None = None


def used_names(text):
    """Local names made accessible by a use statement, each with its module and name there."""
    found = USE.match(text)
    names = {}
    for part in check_style.split_top(found.group(2) or found.group(3) or ""):
        local, _, original = part.partition("=>")
        if part:
            names[local.strip()] = (found.group(1), (original or local).strip())
    return names


def declared(text):
    """Names that a declaration declares, each with its derived type, '' if it has none."""
    found = check_style.DECLARATION.match(text)
    if not found:
        return {}
    derived = OF_TYPE.match(text)
    kind = derived.group(1) if derived else ""
    return {re.match(r"\w*", entity).group(): kind for entity in check_style.split_top(found.group(3))}


class Reader:
    """Reads the modules of one file."""

    def __init__(self, path):
        """Read the file."""
        self.modules = []
        self.module = None
        self.procedure = None
        self.type = None
        self.interface = None
        self.abstract, self.depth = False, 0
        lines = path.read_text(encoding="utf-8").splitlines()
        for statement in check_style.statements(lines):
            self.take(statement.text)

    def take(self, text):
        """Process the next statement."""
        procedure = check_style.PROCEDURE.match(text)
        if self.interface is not None:
            self.take_interface(text, procedure)
        elif self.type:
            self.take_of_type(text)
        elif re.match(r"(abstract\s+)?interface\b", text):
            name = re.match(r"interface\s+(\w+\s*(?:\(.*\))?)$", text)
            self.abstract, self.depth = text.startswith("abstract"), 0
            self.interface = name.group(1).replace(" ", "") if name else ""
        elif check_style.UNIT.match(text):
            self.open_unit(check_style.UNIT.match(text))
        elif procedure and not text.startswith("end"):
            self.open_procedure(text, procedure)
        elif TYPE_HEAD.match(text):
            self.open_type(TYPE_HEAD.match(text))
        elif re.match(r"use\b", text):
            (self.procedure or self.module).uses.update(used_names(text))
        elif END_OF_UNIT.match(text):
            self.procedure = self.procedure.host if self.procedure else None
        elif self.procedure:
            self.procedure.types.update(declared(text))
            self.procedure.statements.append(text)
        elif re.match(r"public\s*::", text):
            self.module.public.update(part.strip() for part in text.split("::")[1].split(","))
        elif re.search(r",\s*public\b.*::", text):
            self.module.public.update(declared(text))

    def open_unit(self, found):
        """Begin a module or program."""
        self.module = Module(found.group(2))
        self.modules.append(self.module)
        if found.group(1) == "program":
            self.module.program = self.procedure = Procedure(found.group(2), found.group(2))

    def open_procedure(self, text, found):
        """Begin a procedure."""
        new = Procedure(found.group(2), self.module.name, self.procedure)
        result = RESULT.search(text)
        name = result.group(1) if result else new.name
        prefix = OF_TYPE.search(text[: found.start(1)])
        new.result = name if found.group(1) == "function" else ""
        if prefix:
            new.types[name] = prefix.group(1)
        (self.procedure.inner if self.procedure else self.module.procedures)[new.name] = new
        self.procedure = new

    def open_type(self, found):
        """Begin a derived type."""
        parent = re.search(r"extends\s*\(\s*(\w+)\s*\)", found.group(1))
        self.type = Type(found.group(2), self.module.name, parent.group(1) if parent else "")
        self.module.types[self.type.name] = self.type
        if re.search(r"\bpublic\b", found.group(1)):
            self.module.public.add(self.type.name)

    def take_of_type(self, text):
        """Process a statement of a derived type."""
        generic, binding = GENERIC.match(text), BINDING.match(text)
        if re.match(r"end\s*type\b", text):
            self.type = None
        elif generic:
            names = [name.strip() for name in generic.group(2).split(",")]
            self.type.generics.setdefault(generic.group(1).replace(" ", ""), []).extend(names)
        elif re.match(r"final\b", text):
            self.type.finals += [name.strip() for name in text.split("::")[1].split(",")]
        elif binding and "pointer" not in (binding.group(2) or ""):
            deferred = binding.group(1) is not None
            for part in check_style.split_top(binding.group(3) or binding.group(4)):
                name, _, target = part.partition("=>")
                self.type.bindings[name.strip()] = None if deferred else (target or name).strip()
        else:
            self.type.components.update(declared(text))

    def take_interface(self, text, procedure):
        """Process a statement of an interface."""
        listed = re.match(r"(?:module\s+)?procedure\s*(?:::)?\s*(\w.*)$", text)
        if re.match(r"end\s*interface\b", text):
            self.interface = None
        elif procedure and not text.startswith("end"):
            self.depth += 1
            if not self.abstract and not self.procedure:
                name = procedure.group(2)
                self.module.procedures[name] = Procedure(name, self.module.name)
                if self.interface:
                    self.module.generics.setdefault(self.interface, []).append(name)
        elif listed and self.interface and not self.depth:
            names = [name.strip() for name in listed.group(1).split(",")]
            self.module.generics.setdefault(self.interface, []).extend(names)
        elif re.match(r"end\b", text):
            self.depth -= 1


def read_modules(paths):
    """All modules of some files, by their names."""
    return {module.name: module for path in paths for module in Reader(path).modules}
