"""Writes the Fortran module `asserts`: one overload for each pair of kinds and ranks, which passes
its flattened arguments to the comparisons. Usage: generate_asserts.py FILE"""

import sys

MAX_RANK = 5
INTEGERS = ["integer(int32)", "integer(int64)"]
REALS = ["real(real32)", "real(real64)"]
INTEGER_PAIRS = [(e, f) for f in INTEGERS for e in INTEGERS if INTEGERS.index(e) <= INTEGERS.index(f)]
REAL_PAIRS = [(e, f) for f in REALS for e in INTEGERS + REALS[: REALS.index(f) + 1]]
RANKS = [(0, 0)] + [(e, f) for f in range(1, MAX_RANK + 1) for e in (0, f)]
COMPARISONS = {
    "assertEqual": ("equal", RANKS, True),
    "assertNotEqual": ("different", RANKS, True),
    "assertRelativelyEqual": ("relatively equal", RANKS, False),
    "assertLessThan": ("<", [(0, 0)], True),
    "assertLessThanOrEqual": ("<=", [(0, 0)], True),
    "assertGreaterThan": (">", [(0, 0)], True),
    "assertGreaterThanOrEqual": (">=", [(0, 0)], True),
}
LOGICALS = {  # condition that passes, what is expected otherwise, ranks
    "assertTrue": ("{0}", "true", [0]),
    "assertFalse": (".not. {0}", "false", [0]),
    "assertAll": ("all({0})", "all true", range(1, MAX_RANK + 1)),
    "assertAny": ("any({0})", "any true", range(1, MAX_RANK + 1)),
    "assertNone": (".not. any({0})", "none true", range(1, MAX_RANK + 1)),
    "assertNotAll": (".not. all({0})", "not all true", range(1, MAX_RANK + 1)),
}
CLASSES = {
    "assertIsNaN": ("ieee_is_nan({0})", "NaN"),
    "assertIsFinite": ("ieee_is_finite({0})", "a finite number"),
    "assertIsInfinite": (".not. (ieee_is_nan({0}) .or. ieee_is_finite({0}))", "infinity"),
}
HEAD = """\
!> Asserts that tests call; each adds a failure if its condition is not met.
module asserts
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
  use, intrinsic :: iso_fortran_env, only: int32, int64, real32, real64
  use comparisons, only: compare, compare_strings
  use test_failures, only: SourceLocation, add_failure
  implicit none
  private
"""
TAIL_ARGUMENTS = """\
    character(len=*), intent(in), optional :: message
    type(SourceLocation), intent(in), optional :: location
"""


def dims(rank):
    """Shape of a dummy argument of a rank."""
    return "(" + ",".join(":" * rank) + ")" if rank else ""


def flat(name, rank, kind):
    """Argument `name` as a vector of the kind that is compared."""
    convert = f"real({name}, real64)" if kind == "real" else f"int({name}, int64)"
    return f"reshape({convert}, [size({name})])" if rank else f"[{convert}]"


def comparison(name, relation, expected, found, ranks):
    """An assert that compares two sides."""
    kind = found.split("(")[0]
    tolerance = "tolerance, " if kind == "real" else ""
    yield f"  subroutine {name}(expected, found, {tolerance}message, location)"
    yield f"    {expected}, intent(in) :: expected{dims(ranks[0])}"
    yield f"    {found}, intent(in) :: found{dims(ranks[1])}"
    if tolerance:
        yield "    class(*), intent(in), optional :: tolerance"
    yield TAIL_ARGUMENTS
    yield f"    call compare('{relation}', {flat('expected', ranks[0], kind)}, &"
    yield f"      {flat('found', ranks[1], kind)}, &"
    yield f"      shape(expected), shape(found), {tolerance}message, location)"
    yield f"  end subroutine {name}\n"


def judgement(name, argument, passes, expected):
    """An assert of one argument."""
    yield f"  subroutine {name}(actual, message, location)"
    yield f"    {argument}"
    yield TAIL_ARGUMENTS
    yield f"    if ({passes.format('actual')}) return"
    yield f"    call add_failure('expected {expected}, found otherwise', message, location)"
    yield f"  end subroutine {name}\n"


def overloads():
    """Pairs (name of the assert, lines of one overload, its specific name)."""
    for name, (relation, ranks_list, whole_numbers) in COMPARISONS.items():
        for expected, found in REAL_PAIRS + (INTEGER_PAIRS if whole_numbers else []):
            for ranks in ranks_list:
                specific = "_".join([name, *(t[:-1].split("(")[1] for t in (expected, found)), *map(str, ranks)])
                yield name, specific, comparison(specific, relation, expected, found, ranks)
    for name, (passes, expected, ranks) in LOGICALS.items():
        for rank in ranks:
            argument = f"logical, intent(in) :: actual{dims(rank)}"
            yield name, f"{name}_{rank}", judgement(f"{name}_{rank}", argument, passes, expected)
    for name, (passes, expected) in CLASSES.items():
        for real in REALS:
            specific = f"{name}_{real[5:-1]}"
            yield name, specific, judgement(specific, f"{real}, intent(in) :: actual", passes, expected)


STRINGS = """\
  subroutine assertEqual_strings(expected, found, message, location, whitespace)
    character(len=*), intent(in) :: expected, found
{0}    integer, intent(in), optional :: whitespace

    call compare_strings('equal', expected, found, whitespace, message, location)
  end subroutine assertEqual_strings

  subroutine assertNotEqual_strings(expected, found, message, location, whitespace)
    character(len=*), intent(in) :: expected, found
{0}    integer, intent(in), optional :: whitespace

    call compare_strings('different', expected, found, whitespace, message, location)
  end subroutine assertNotEqual_strings

  subroutine assertEquivalent(expected, found, message, location)
    logical, intent(in) :: expected, found
{0}
    if (expected .neqv. found) call add_failure('expected equivalent, found otherwise', message, location)
  end subroutine assertEquivalent

  subroutine assertSameShape(expected, found, message, location)
    integer, intent(in) :: expected(:), found(:)
{0}
    call compare('equal', int(expected, int64), int(found, int64), shape(expected), shape(found), message, location)
  end subroutine assertSameShape

  subroutine assertFail(message, location)
{0}
    call add_failure('failed', message, location)
  end subroutine assertFail
"""


def main(path):
    """Write the module to a file."""
    procedures, interfaces = [], {}
    for name, specific, lines in overloads():
        procedures += lines
        interfaces.setdefault(name, []).append(specific)
    for name in ("assertEqual", "assertNotEqual"):
        interfaces[name].append(f"{name}_strings")
    with open(path, "w", encoding="utf-8") as out:
        out.write(HEAD)
        for name in [*interfaces, "assertEquivalent", "assertSameShape", "assertFail"]:
            out.write(f"  public :: {name}\n")
        for name, specifics in interfaces.items():
            out.write(f"\n  interface {name}\n")
            out.writelines(f"    module procedure {specific}\n" for specific in specifics)
            out.write(f"  end interface {name}\n")
        out.write("\ncontains\n\n" + "\n".join(procedures) + STRINGS.format(TAIL_ARGUMENTS))
        out.write("end module asserts\n")


if __name__ == "__main__":
    main(sys.argv[1])
