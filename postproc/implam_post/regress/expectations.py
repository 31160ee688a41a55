"""Expected values of runs: the file that `implam-compare` and `implam-regress` read."""

import math
import re
import tomllib
from dataclasses import dataclass, field, fields
from pathlib import Path

from implam_post.io.deck_text import KeyPath, key_path
from implam_post.io.errors import FileError, ImplamError
from implam_post.io.files import read_text
from implam_post.io.quantities import AGAINST_QUANTITIES, COLUMN_QUANTITIES, QUANTITIES

FORMAT = """
The file of expectations, of which at least one is needed:

    deck = "sun_chen.nml"            # the deck to run; default: NAME.nml in the folder of this file NAME.toml

    [[expect]]                       # of every variant
    quantity = "peak_force"
    value = 298.87
    relative = 0.015                 # tolerance as a fraction of the value; or absolute = 4.5

    [[expect]]
    quantity = "at"                  # a column of the history at a time
    column = "impactor_velocity"
    time = 1.0e-3
    value = -0.5178
    absolute = 0.01

    [[expect]]
    quantity = "final"               # the last row of a column; max, min and max_abs likewise
    column = "delaminated_area"
    value = 1.79e-4
    relative = 1e-3

    [[expect]]
    quantity = "rms_force"           # over the first contact, as a fraction of the peak
    against = "deck.nml"             # a deck: its semi-analytic solution; or a history, in the folder of this file or
    value = 0.0                      # else that of the history, where deck.nml is the deck of the run
    absolute = 0.01                  # l2_force: relative L2 difference over the time of the other history

    [[curve]]                        # optional: a measured curve for --plot, a CSV in the folder of this file
    file = "measured.csv"            # first two columns: columns of the history such as time, force, deflection

    [[variant]]                      # optional: runs of the deck with other keys
    name = "fast"
    set = ["impactor%velocity=30", "laminate%angles=0,90,0", "delamination[2]%G_c=400"]
    [[variant.expect]]               # of this variant, in addition to those at the top
    quantity = "peak_force"
    value = 3120.0
    relative = 0.01

Quantities: """
FORMAT += ", ".join(QUANTITIES) + ".\n"
AS_IT_IS = "as_it_is"


@dataclass(frozen=True)
class Expectation:
    """A quantity, its expected value and tolerance, and its column, time or other history."""

    quantity: str
    value: float
    relative: float | None = None
    absolute: float | None = None
    column: str = ""
    time: float | None = None
    against: str = ""

    def __post_init__(self) -> None:
        """Refuse entries that cannot be evaluated or cannot fail."""
        if self.time is not None and not _is_number(self.time):
            raise FileError(f"{self.quantity}: time must be a finite number.")
        known = [*QUANTITIES, *COLUMN_QUANTITIES, "at", *AGAINST_QUANTITIES]
        tolerances = [tolerance for tolerance in (self.relative, self.absolute) if tolerance is not None]
        if self.quantity not in known:
            raise FileError(f"'{self.quantity}' is not one of the quantities {', '.join(known)}.")
        if not _is_number(self.value) or len(tolerances) != 1 or not all(map(_is_number, tolerances)):
            raise FileError(f"{self.label}: a value and one of relative and absolute are required, as finite numbers.")
        if self.relative is not None and self.value == 0:
            raise FileError(f"{self.label}: a tolerance relative to zero is meaningless; use absolute.")
        if (self.quantity in COLUMN_QUANTITIES or self.quantity == "at") == (not self.column):
            columns = ", ".join([*COLUMN_QUANTITIES, "at"])
            raise FileError(f"{self.label}: {columns} require a column, other quantities do not have one.")
        if (self.quantity == "at") != _is_number(self.time):
            raise FileError(f"{self.label}: the quantity at requires a time, other quantities do not have one.")
        if (self.quantity in AGAINST_QUANTITIES) == (not self.against):
            raise FileError(f"{self.label}: {' and '.join(AGAINST_QUANTITIES)} require against, others do not have it.")

    @property
    def label(self) -> str:
        """Name of the entry in tables and messages."""
        time = "" if self.time is None else f" at {self.time:g}"
        return f"{self.column}{time}" if self.quantity == "at" else " ".join(
            word for word in (self.quantity, self.column, self.against) if word)

    @property
    def tolerance(self) -> float:
        """Largest difference accepted."""
        return abs(self.relative * self.value) if self.absolute is None else self.absolute


@dataclass(frozen=True)
class Variant:
    """A run of the deck with changed keys, and all its expectations; common ones come first."""

    name: str
    settings: dict[KeyPath, str]
    expectations: list[Expectation]


@dataclass(frozen=True)
class Expectations:
    """A file of expectations; `common` are those at the top, `curves` files of measured curves."""

    path: Path
    deck: str
    common: list[Expectation] = field(default_factory=list)
    variants: list[Variant] = field(default_factory=list)
    curves: list[Path] = field(default_factory=list)

    def variant(self, name: str | None = None) -> Variant:
        """Return a variant by its name, which may be omitted if there is only one."""
        names = [variant.name for variant in self.variants]
        if name not in names and (name is not None or len(names) > 1):
            problem = "the file has several variants" if name is None else f"no variant is named '{name}'"
            raise FileError(f"{self.path}: {problem}; variants are {', '.join(names)}.")
        return self.variants[0 if name is None else names.index(name)]


def read_expectations(path: Path | str) -> Expectations:
    """Read a file of expectations."""
    path = Path(path)
    text = read_text(path, "the expectations")
    try:
        return parse_expectations(path, tomllib.loads(text))
    except (tomllib.TOMLDecodeError, TypeError, ImplamError) as error:
        raise FileError(f"the expectations {path}: {error}") from None


def parse_expectations(path: Path, content: dict) -> Expectations:
    """Return the expectations of the content of a file."""
    deck, common = content.pop("deck", f"{path.stem}.nml"), _entries(content.pop("expect", []))
    tables, curves = content.pop("variant", [{"name": AS_IT_IS}]), _curves(content.pop("curve", []), path.parent)
    if content or not isinstance(deck, str) or not isinstance(tables, list):
        raise FileError("only deck, [[expect]], [[variant]] and [[curve]] entries are allowed.")
    variants = [_variant(table, common) for table in tables]
    names = [variant.name for variant in variants]
    if len(set(names)) < len(names) or not names:
        raise FileError("names of variants must be unique.")
    return Expectations(path, deck, common, variants, curves)


def _variant(table: dict, common: list[Expectation]) -> Variant:
    """Return one variant."""
    if not isinstance(table, dict):
        raise FileError("variant must be a list of tables: [[variant]].")
    name, settings = table.get("name", ""), table.get("set", [])
    if not isinstance(name, str) or not isinstance(settings, list) or not all(isinstance(one, str) for one in settings):
        raise FileError("name of a variant must be a text, and set a list of texts.")
    if not set(table) <= {"name", "set", "expect"} or not re.fullmatch(r"[\w.+-]+", name) or name.startswith("."):
        raise FileError(f"a variant has a name of letters, digits and _.+-, set and expect; found {', '.join(table)}.")
    keys = {}
    for setting in settings:
        target, _, value = setting.partition("=")
        key = key_path(target)
        if key is None or not value.strip():
            raise FileError(f"variant {name}: '{setting}' is not group%key=value.")
        keys[key] = value.strip()
    expectations = common + _entries(table.get("expect", []))
    if not expectations:
        raise FileError(f"there is no expectation{'' if name == AS_IT_IS else f' of the variant {name}'}: an "
                        "[[expect]] entry is required.")
    return Variant(name, keys, expectations)


def _curves(tables: object, folder: Path) -> list[Path]:
    """Return the files of measured curves."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) and set(table) == {"file"} for table in tables):
        raise FileError("curve must be a list of tables with a file: [[curve]].")
    return [folder / str(table["file"]) for table in tables]


def _entries(tables: object) -> list[Expectation]:
    """Return a list of entries."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise FileError("expect must be a list of tables: [[expect]].")
    kinds = {entry.name: entry for entry in fields(Expectation)}
    for table in tables:
        unknown, missing = [*table.keys() - kinds.keys()], [*{"quantity", "value"} - table.keys()]
        if unknown:
            raise FileError(f"an [[expect]] entry has no {', '.join(sorted(unknown))}; keys are {', '.join(kinds)}.")
        if missing:
            raise FileError(f"an [[expect]] entry lacks {' and '.join(sorted(missing))}.")
        if not all(isinstance(table.get(name, ""), str) for name in ("quantity", "column", "against")):
            raise FileError("quantity, column and against of an [[expect]] entry must be texts.")
    return [Expectation(**table) for table in tables]


def _is_number(value: object) -> bool:
    """Return whether `value` is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
