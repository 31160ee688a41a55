"""Checks that the Fortran sources keep the rules of the project. Usage:
check_style.py FOLDER... [--layout FOLDER...]

In folders after --layout, those of tests, only the layout is checked. Prints one line a breach, as
file:line: sentence, and ends with code 1 if there is any. A type may exceed the number of components, inherited ones
included, if its documentation gives the reason, in a sentence with "because".
"""

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

MAX_COLUMNS = 120
MAX_PROCEDURE = 60
# Branches of a procedure in the folders of the implicit solution, where control flow is hard to follow.
CORE = {"newton", "linalg", "statics", "dynamics", "stepping"}
MAX_BRANCHES = 15
BRANCH = re.compile(r"\bif\s*\(|\.and\.|\.or\.|^case\s*\(|^(?:\w+\s*:\s*)?do\b(?!\s*=)")
MAX_FILE = 400
MAX_FILE_OF_TESTS = 600
MAX_COMPONENTS = 15
# Fraction of a program's lines allowed in one folder, for programs of more lines than the second number.
MAX_FOLDER, SMALL_PROGRAM = 0.15, 5000
INDENT = 2
SUFFIXES = (".f90", ".F90", ".pf")
# Terms with one name and one spelling, and the others; a public column is refactorisations.
SPELLINGS = {
    "factorization": re.compile(r"(?<!re)factoris|factoris(?!ations\b)", re.IGNORECASE),
    "time stepping": re.compile(r"\bmarch(es|ed|ing)?\b", re.IGNORECASE),
    "contact and ties": re.compile(r"\bseparations\b", re.IGNORECASE),
}
# Arguments with one meaning in all of the program, which need no documentation.
COMMON_ARGUMENTS = {"self", "model", "deck", "settings", "problems", "now", "archive", "log", "error", "law"}
# Arguments that their names explain where they have no documentation.
NAMED_ARGUMENTS = {
    "group", "key", "name", "path", "word", "point", "number", "line", "row", "part", "distance", "matrix", "method",
    "rank", "summary", "text", "option", "message", "area", "radius", "energy", "tolerance",
}
# Names in a list of arguments that are none of those to document.
NO_ARGUMENTS = {"", "*", "self", "this"}
# A comment of a common argument that says more, such as what is changed in it, has more words than this.
MAX_COMMON_WORDS = 4
# Words that say nothing of an argument.
FILLERS = {"the", "a", "an", "its", "this", "of", "in", "for", "to", "all", "that", "and", "with", "one"}
# Libraries whose modules are used without `only`.
WHOLE_MODULES = {"mpi", "mpi_f08", "hdf5"}

PREFIX = (
    r"(?:(?:pure|impure|elemental|recursive|module)\s+|"
    r"(?:integer|real|logical|complex|character|type|class|double)\b[^:!]*?\s+)*"
)
UNIT = re.compile(r"(module|submodule|program)\s+(?!procedure\b|subroutine\b|function\b)(?:\(.*?\)\s*)?(\w+)$")
PROCEDURE = re.compile(PREFIX + r"(subroutine|function)\s+(\w+)\s*(\((.*?)\))?")
MODULE_PROCEDURE = re.compile(r"module\s+procedure\s+(\w+)$")
TYPE = re.compile(r"type(?:\s*,[^:]*)?\s*(?:::)?\s*(\w+)$|type\s*,.*::\s*(\w+)$")
CONSTRUCT = re.compile(
    r"(?:\w+\s*:\s*)?(?:if\s*\(.*\)\s*then|do\b(?!\s*=)|select\s*(?:case|type|rank)\b|associate\s*\(|block|critical|"
    r"(?:where|forall)\s*(?P<mask>\(.*))$|(?:\w+\s*:\s*)?(?:do\b.*|select\s*(?:case|type|rank)\s*\(.*|associate\s*\(.*)$"
)
MIDDLE = re.compile(r"(?:else|elsewhere|case|contains)\b(?!\s*=)|(?:class|type)\s+(?:is|default)\b|rank\s*\(")
END = re.compile(r"end\s*(?!file\b)(\w*)\b\s*\w*$")
DECLARATION = re.compile(
    r"(integer|real|logical|complex|character|double\s+precision|type\s*\(|class\s*\(|procedure\s*\()(.*?)::(.*)$"
)


@dataclass
class Statement:
    """One statement, its continuation lines joined, its strings emptied, in lower case."""

    line: int
    last: int
    indent: int
    text: str
    documented: bool


@dataclass
class Scope:
    """An open program unit, procedure, type, interface or construct."""

    kind: str
    line: int
    name: str = ""
    arguments: set = field(default_factory=set)
    statements: set = field(default_factory=set)
    components: int = 0
    parent: str = ""
    branches: int = 1


def without_strings(line, quote):
    """The line without comment and contents of strings, and the quote still open at its end."""
    out = []
    for character in line:
        if quote:
            if character == quote:
                quote = ""
                out.append(character)
        elif character == "!":
            break
        else:
            quote = character if character in "'\"" else ""
            out.append(character)
    if quote and line.rstrip().endswith("&"):
        out.append("&")
    return "".join(out), quote


def statements(lines):
    """The statements of a file. Documented: a line starting with !> is directly above."""
    current, documented, quote = None, False, ""
    for number, line in enumerate(lines, 1):
        if line.lstrip().startswith("!"):
            documented = documented if current else documented or line.lstrip().startswith("!>")
            continue
        if line.startswith("#"):
            continue
        code, quote = without_strings(line, quote)
        code = code.rstrip()
        if not code:
            documented = documented if current else False
            continue
        # Of a line within a string only the sign of the next line is left.
        text = code.strip() if code.strip() == "&" else code.strip().lstrip("&").lower()
        if current:
            current.text += " " + text.strip()
        else:
            current = Statement(number, number, len(code) - len(code.lstrip()), text.strip(), documented)
        current.last = number
        if current.text.endswith("&"):
            current.text = current.text[:-1].rstrip()
        else:
            yield current
            current, documented, quote = None, False, ""


def split_top(text):
    """Splits at commas outside brackets."""
    parts, depth = [""], 0
    for character in text:
        depth += (character in "([") - (character in ")]")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]


def initialised(entity):
    """Whether a declared entity has a value."""
    flat = re.sub(r"\([^()]*\)", "", re.sub(r"\([^()]*\)", "", entity))
    return "=" in flat


def words_of(text):
    """The words of a text or of a Fortran name without plurals and words that say nothing."""
    return {word.rstrip("s") for word in re.findall(r"[a-z]+|[<>]", text.lower())} - FILLERS


def names_and_type(text):
    """The names that a declaration declares, and their derived type; none if it is no declaration."""
    found = DECLARATION.match(text)
    if not found:
        return [], ""
    derived = re.match(r"\((\w+)\)", found.group(2)) if found.group(1).endswith("(") else None
    derived = derived or re.match(r"\s*(\w+)\)", found.group(2))
    of_type = derived.group(1) if derived and re.match(r"(type|class)", found.group(1)) else ""
    return [re.match(r"\w*", entity).group() for entity in split_top(found.group(3))], of_type


def conventions():
    """Meanings by name and declared type, shape included, of the table of names in doc/architecture.md."""
    page = (Path(__file__).parents[2] / "doc" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`\w+`(?:, `\w+`)*) \| `([^`]*)` \| (.*) \|$", page, re.MULTILINE)
    return {(name, kind): words_of(meaning) for names, kind, meaning in rows for name in re.findall(r"\w+", names)}


def meanings_of(text):
    """The words of the meanings that the table of names gives to arguments; None: one has none there."""
    found = DECLARATION.match(text)
    kind = re.match(r"\w+(?:\s*\([\w=*: ]*\))?", text).group().replace("(wp)", "")
    words = set()
    for entity in split_top(found.group(3)) if found else []:
        name, shape = re.match(r"(\w+)\s*(\(.*\))?", entity).groups()
        meaning = {name} if name in COMMON_ARGUMENTS else CONVENTIONS.get((name, kind + (shape or "").replace(" ", "")))
        if meaning is None:
            return None
        words |= meaning
    return words or None


def needs_no_doc(text, is_argument):
    """Whether name and type of an argument or component say what it is, or the table of names does."""
    names, of_type = names_and_type(text)
    known = words_of(of_type.replace("_", " "))
    common = COMMON_ARGUMENTS | NAMED_ARGUMENTS if is_argument else set()
    return (is_argument and meanings_of(text) is not None) or all(
        name in common or words_of(name.replace("_", " ")) <= known for name in names
    )


def is_redundant(text, doc, is_argument):
    """Whether documentation says no more than name, type and the table of names."""
    names, of_type = names_and_type(text)
    if len(names) != 1:
        return False
    if is_argument and names[0] in COMMON_ARGUMENTS and len(re.findall(r"\w+", doc)) <= MAX_COMMON_WORDS:
        return True
    meaning = (meanings_of(text) if is_argument else None) or set()
    return words_of(doc) <= words_of(names[0].replace("_", " ")) | words_of(of_type.replace("_", " ")) | meaning


def doc_above(lines, line):
    """Documentation directly above a line."""
    first = line - 1
    while first > 0 and lines[first - 1].lstrip().startswith("!>"):
        first -= 1
    return " ".join(text.lstrip()[2:].strip() for text in lines[first : line - 1])


def deferred_arguments(checkers):
    """The sets of two or more arguments of abstract interfaces, which document them for all procedures with these."""
    found, inside = set(), False
    for statement in (statement for checker in checkers for statement in statements(checker.lines)):
        if re.match(r"(abstract|end)\s*interface\b", statement.text):
            inside = statement.text.startswith("abstract")
        procedure = PROCEDURE.match(statement.text) if inside and not statement.text.startswith("end") else None
        arguments = frozenset(split_top(procedure.group(4) or "")) - NO_ARGUMENTS if procedure else ()
        if len(arguments) > 1:
            found.add(arguments)
    return found


CONVENTIONS = conventions()


class Checker:
    """Reads the statements of one file and collects breaches."""

    def __init__(self, path):
        """Read the file."""
        self.path = path
        self.deferred = set()
        self.lines = path.read_text(encoding="utf-8").splitlines()
        self.breaches = []
        self.scopes = []
        self.bound = set()
        self.types = []

    def report(self, line, sentence):
        """Add a breach."""
        self.breaches.append((line, f"{self.path}:{line}: {sentence}"))

    def check(self, whole):
        """Return the breaches of the layout, or of all rules, in the order of lines."""
        self.check_layout(MAX_FILE if whole else MAX_FILE_OF_TESTS)
        for statement in statements(self.lines) if whole else ():
            self.check_indent(statement)
            self.check_selectors(statement)
            self.check_words(statement)
            self.walk(statement)
        return [text for _, text in sorted(self.breaches)]

    def check_layout(self, max_lines):
        """Check rules that need no parsing of Fortran."""
        if len(self.lines) > max_lines:
            self.report(len(self.lines), f"the file has more than {max_lines} lines")
        for number, line in enumerate(self.lines, 1):
            if "\t" in line:
                self.report(number, "tab")
            if line != line.rstrip():
                self.report(number, "trailing blank")
            if len(line) > MAX_COLUMNS:
                self.report(number, f"more than {MAX_COLUMNS} columns")
            for word, other in SPELLINGS.items():
                if other.search(line):
                    self.report(number, f"another name or spelling of {word}")

    def check_indent(self, statement):
        """Check the indentation of a statement's first line."""
        closes = END.match(statement.text) or MIDDLE.match(statement.text)
        wanted = INDENT * (len(self.scopes) - bool(closes and self.scopes))
        if statement.indent != wanted:
            self.report(statement.line, f"indented by {statement.indent}, not {wanted} blanks")

    def check_selectors(self, statement):
        """Check that no selector calls one of the file's own type-bound functions in a subscript: GNU 14 refuses it."""
        bound = re.match(r"procedure\b[^:]*::\s*(.*)$", statement.text)
        if bound:
            self.bound |= {re.match(r"\w+", name).group() for name in split_top(bound.group(1))}
        if not re.match(r"associate\s*\(", statement.text):
            return
        depth = 0
        for part in re.finditer(r"[()]|%(\w+)(?=\()", statement.text):
            depth += (part.group() == "(") - (part.group() == ")")
            if depth > 1 and part.group(1) in self.bound:
                self.report(statement.line, f"{part.group(1)} is called within the selector of an associate")

    def check_words(self, statement):
        """Check for statements that are not allowed in the project."""
        text = statement.text
        action = re.sub(r"^if\s*\(.*?\)\s*(?=(error\s+)?stop\b|go\s*to\b)", "", text)
        if re.match(r"save\b(?!\s*=)", text) or re.search(r",\s*save\b.*::", text):
            self.report(statement.line, "save: a module keeps no state")
        if re.match(r"(error\s+)?stop\b(?!\s*[=(%])", action) and self.path.name != "main.f90":
            self.report(statement.line, "stop: errors are returned, only main stops the program")
        if re.match(r"go\s*to\s+\d", action):
            self.report(statement.line, "goto")
        used = re.match(r"use\b\s*(?:,\s*\w+\s*::)?\s*(\w+)(.*)", text)
        whole = used and (used.group(1) in WHOLE_MODULES or used.group(1).startswith("petsc"))
        if used and not whole and not re.match(r"\s*,\s*only\s*:", used.group(2)):
            self.report(statement.line, f"use {used.group(1)} without only")

    def walk(self, statement):
        """Update the nesting and check what begins or ends here."""
        text = statement.text
        inner = self.scopes[-1] if self.scopes else None
        around = next((scope for scope in reversed(self.scopes) if scope.kind == "procedure"), None)
        if around and not text.startswith("end"):
            around.branches += len(BRANCH.findall(text))
        if END.match(text) and inner:
            self.close(self.scopes.pop(), statement)
            return
        if inner and re.match(r"implicit\s+none\b|private$", text):
            inner.statements.add(text.split()[0])
        unit, procedure, kind = UNIT.match(text), PROCEDURE.match(text), TYPE.match(text)
        if unit:
            self.open_unit(unit, statement)
        elif procedure and not text.startswith("end"):
            arguments = set(split_top(procedure.group(4) or "")) - NO_ARGUMENTS
            self.require_doc(statement, f"{procedure.group(1)} {procedure.group(2)}")
            self.scopes.append(Scope("procedure", statement.line, procedure.group(2), arguments))
        elif MODULE_PROCEDURE.match(text) and (not inner or inner.kind != "interface"):
            self.scopes.append(Scope("procedure", statement.line, MODULE_PROCEDURE.match(text).group(1)))
        elif kind and not text.startswith("type is"):
            name = kind.group(1) or kind.group(2)
            self.require_doc(statement, f"type {name}")
            extended = re.search(r"extends\s*\(\s*(\w+)", text)
            self.scopes.append(Scope("type", statement.line, name, parent=extended.group(1) if extended else ""))
        elif re.match(r"(abstract\s+)?interface\b", text):
            self.scopes.append(Scope("interface", statement.line))
        elif self.opens_construct(text):
            self.scopes.append(Scope("construct", statement.line))
        else:
            self.check_declaration(statement, inner)

    @staticmethod
    def opens_construct(text):
        """Return whether a statement opens a construct (a where or forall may be a statement of its own)."""
        found = CONSTRUCT.match(text)
        if not found:
            return re.match(r"enum\s*,", text) is not None
        mask = found.group("mask")
        if mask is None:
            return True
        depth = 0
        for position, character in enumerate(mask):
            depth += (character == "(") - (character == ")")
            if depth == 0:
                return not mask[position + 1 :].strip()
        return False

    def open_unit(self, unit, statement):
        """Begin a module or program."""
        self.require_doc(statement, f"{unit.group(1)} {unit.group(2)}")
        self.scopes.append(Scope(unit.group(1), statement.line, unit.group(2)))
        if unit.group(1) == "module" and unit.group(2) != self.path.stem.lower():
            self.report(statement.line, f"module {unit.group(2)} is in a file of another name")

    def close(self, scope, statement):
        """Check rules at the end of a scope."""
        if scope.kind == "module":
            if "implicit" not in scope.statements:
                self.report(scope.line, f"module {scope.name} has no implicit none")
            if "private" not in scope.statements:
                self.report(scope.line, f"module {scope.name} is not private")
        core = self.path.parent.name in CORE and self.path.parent.parent.name == "src"
        if scope.kind == "procedure" and statement.line - scope.line + 1 > MAX_PROCEDURE:
            self.report(scope.line, f"{scope.name} has more than {MAX_PROCEDURE} lines")
        if scope.kind == "procedure" and core and scope.branches > MAX_BRANCHES:
            self.report(scope.line, f"{scope.name} has {scope.branches} branches, more than {MAX_BRANCHES}")
        doc = doc_above(self.lines, scope.line)
        if scope.kind == "type":
            self.types.append((scope, f"{self.path}:{scope.line}", "because" in doc))

    def require_doc(self, statement, what):
        """Check that documentation is above a statement."""
        if not statement.documented:
            self.report(statement.line, f"{what} has no !> documentation above it")

    def check_doc(self, statement, what, is_deferred=False):
        """Check that it is documented where its name and type do not say all, and only there."""
        is_argument = what.startswith("argument")
        if not (is_deferred or needs_no_doc(statement.text, is_argument)):
            self.require_doc(statement, what)
        elif statement.documented and is_redundant(statement.text, doc_above(self.lines, statement.line), is_argument):
            self.report(statement.line, f"the documentation of {what} says no more than name and type")

    def check_declaration(self, statement, scope):
        """Check a declaration by its scope."""
        found = DECLARATION.match(statement.text)
        if not found or not scope:
            return
        attributes, entities = found.group(1) + found.group(2), split_top(found.group(3))
        names = [re.match(r"\w*", entity).group() for entity in entities]
        constant = re.search(r"\bparameter\b", attributes)
        if scope.kind == "type" and not found.group(1).startswith("procedure"):
            self.check_doc(statement, f"component {', '.join(names)}")
            scope.components += len(names)
        elif scope.kind == "module" and not constant:
            self.report(statement.line, f"module variable {', '.join(names)}")
        elif scope.kind in ("procedure", "construct") and not constant:
            for name, entity in zip(names, entities, strict=True):
                if initialised(entity):
                    self.report(statement.line, f"{name} is initialised where it is declared, so it is saved")
        if scope.kind == "procedure" and scope.arguments.intersection(names):
            is_deferred = frozenset(scope.arguments) in self.deferred and self.scopes[-2].kind != "interface"
            self.check_doc(statement, f"argument {', '.join(names)}", is_deferred)


def folder_breaches(folder, files):
    """Folders of a program with too large a fraction of its lines."""
    lines = {}
    for path in files:
        name = path.relative_to(folder).parts[0]
        lines[name] = lines.get(name, 0) + len(path.read_text(encoding="utf-8").splitlines())
    total = sum(lines.values())
    large = [name for name in lines if total > SMALL_PROGRAM and lines[name] > MAX_FOLDER * total]
    return [f"{Path(folder, name)}:1: {lines[name]} of {total} lines are more than {MAX_FOLDER:.0%}" for name in large]


def large_types(types):
    """Breaches of types with too many components, inherited ones included, and no reason."""
    by_name = {scope.name: scope for scope, _, _ in types}

    def total(scope):
        inherited = total(by_name[scope.parent]) if scope.parent in by_name else 0
        return scope.components + inherited

    return [
        f"{place}: type {scope.name} has {total(scope)} components, more than {MAX_COMPONENTS}, and does not say "
        "because of what"
        for scope, place, has_reason in types
        if total(scope) > MAX_COMPONENTS and not has_reason
    ]


def main(arguments):
    """Check folders; return the exit code."""
    count, breaches, whole = 0, [], True
    for argument in arguments:
        if argument == "--layout":
            whole = False
            continue
        files = sorted(p for p in Path(argument).rglob("*") if p.suffix in SUFFIXES)
        count += len(files)
        checkers = [Checker(path) for path in files]
        deferred = deferred_arguments(checkers) if whole else set()
        for checker in checkers:
            checker.deferred = deferred
        breaches += [breach for checker in checkers for breach in checker.check(whole)]
        breaches += large_types([found for checker in checkers for found in checker.types])
        breaches += folder_breaches(argument, files) if whole else []
    print("\n".join(breaches) if breaches else f"{count} files keep the rules")
    return 1 if breaches or not count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
