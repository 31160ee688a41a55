"""Shows that the checker accepts good code and finds each kind of breach."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_style

GOOD = """\
!> A thing.
module good
  use kinds, only: wp
  use mpi
  implicit none
  private
  public :: thing_t, double

  !> Kinds of things, in a text that goes on & over
  character(len=*), parameter :: rows(*) = [character(len=20) :: &
    'one; save | &
      &goto 1 ! stop | &
      &end', &
    'two']

  !> Thing
  type, abstract :: thing_t
    !> Size
    real(wp) :: size = 0
    !> Parts
    type(thing_t), pointer :: part => null()
  contains
    procedure(measure), deferred :: area
  end type thing_t

  abstract interface
    !> Area of a thing.
    real(wp) function measure(self)
      import :: thing_t, wp
      class(thing_t), intent(in) :: self
    end function measure

    !> Sets the extents of a thing.
    subroutine set_extents(self, length, width)
      import :: thing_t, wp
      class(thing_t), intent(inout) :: self
      !> Along x
      real(wp), intent(in) :: length
      !> Along y
      real(wp), intent(in) :: width
    end subroutine set_extents
  end interface

contains

  !> Twice a value.
  pure real(wp) function double(amount, shape) result(twice)
    !> What is doubled
    real(wp), intent(in) :: amount
    !> Shape, which goes &
    !> on
    integer, intent(in), &
      optional :: shape(:)
    real(wp) :: save_it(merge(2, 1, amount == 1))
    integer, parameter :: two = 2
    integer :: i

    if (amount > 0) save_it(1) = 1
    where (save_it > 0) save_it = 1
    outer: do i = 1, 2
      select case (i)
      case (1)
        twice = two*amount
      case default
        if (i == 2) exit outer
      end select
    end do outer
    associate (v => amount)
      if (v > 0 .and. &
          v < 1) then
        twice = v
      else if (v > 1) then
        twice = 2
      else
        twice = 3
      end if
    end associate
  end function double

  !> Sets the extents of a square.
  subroutine set_square(self, length, width)
    class(thing_t), intent(inout) :: self
    real(wp), intent(in) :: length, width

    self%size = max(length, width)
  end subroutine set_square

  !> Sizes of things.
  subroutine list(thing, sizes, log, along)
    class(thing_t), intent(in) :: thing
    !> Sizes, m
    real(wp), intent(out) :: sizes(:)
    !> Receives a line for each thing
    integer, intent(in) :: log
    integer, intent(in) :: along

    sizes = thing%size
  end subroutine list
end module good
"""

MANY = ", &\n      ".join(f"size{i} = {i}" for i in range(15))
# name of the breach: (text in GOOD, its replacement, words of the report)
BREACHES = {
    "tab": ("    integer :: i\n", "    integer ::\ti\n", "tab"),
    "blank": ("  private\n", "  private \n", "trailing blank"),
    "columns": ("twice = 3", "twice = 3" + "0" * 120, "more than 120 columns"),
    "implicit": ("  implicit none\n", "", "no implicit none"),
    "private": ("  private\n", "", "is not private"),
    "name": ("module good", "module bad", "another name"),
    "save": ("    integer :: i\n", "    integer, save :: i\n", "keeps no state"),
    "stop": ("twice = 3", "stop 3", "only main stops"),
    "stop after if": ("exit outer", "error stop 'x'", "only main stops"),
    "goto": ("exit outer", "go to 10", "goto"),
    "use": ("use kinds, only: wp", "use kinds", "without only"),
    "initialised": ("    integer :: i\n", "    integer :: i = 1\n", "initialised"),
    "initialised array": ("    integer :: i\n", "    integer :: i, n(2) = [1, 2]\n", "initialised"),
    "module variable": ("  public :: thing_t", "  integer :: counter\n  public :: thing_t", "module variable"),
    "module doc": ("!> A thing.\n", "", "module good has no"),
    "type doc": ("  !> Thing\n", "", "type thing_t has no"),
    "component doc": ("    !> Size\n", "", "component size has no"),
    "procedure doc": ("  !> Twice a value.\n", "", "function double has no"),
    "interface doc": ("    !> Area of a thing.\n", "", "function measure has no"),
    "argument doc of an interface": ("      !> Along x\n", "", "argument length has no"),
    "argument doc": ("    !> What is doubled\n", "", "argument amount has no"),
    "plain comment is no doc": ("    !> What is doubled\n", "    ! The value\n", "argument amount has no"),
    "doc of an argument of another type": ("    !> Sizes, m\n", "", "argument sizes has no"),
    "doc that repeats the type": (
        "    class(thing_t), intent(in) :: thing\n",
        "    !> The thing\n    class(thing_t), intent(in) :: thing\n",
        "the documentation of argument thing says no more",
    ),
    "doc that repeats the table of names": (
        "    integer, intent(in) :: along\n",
        "    !> 1 for x, 2 for y\n    integer, intent(in) :: along\n",
        "the documentation of argument along says no more",
    ),
    "doc of a common argument": (
        "Receives a line for each thing",
        "The log",
        "the documentation of argument log says no more",
    ),
    "indent": ("        twice = 3", "       twice = 3", "indented by 7, not 8"),
    "long procedure": ("        twice = 3\n", "        twice = 3\n" * 100, "more than 60 lines"),
    "long file": ("!> A thing.\n", "! Why\n" * 400 + "!> A thing.\n", "more than 400 lines"),
    "many components": ("    real(wp) :: size = 0\n", f"    real(wp) :: {MANY}\n", "has 16 components, more than 15"),
    "spelling": ("!> A thing.\n", "!> A Factorised thing.\n", "another name or spelling of factorization"),
    "selector": ("v => amount", "v => self%list(self%area(i))%size", "area is called within the selector"),
    "march": ("    !> Size\n", "    !> The march\n", "another name or spelling of time stepping"),
}


class StyleTest(unittest.TestCase):
    """The checker on a good file and on files with one breach each."""

    def check(self, text):
        """Run the checker on a file; return its exit code and report."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as out:
            Path(folder, "good.f90").write_text(text, encoding="utf-8")
            code = check_style.main([folder])
        return code, out.getvalue()

    def test_good_code_passes(self):
        """There is no false alarm."""
        self.assertEqual(self.check(GOOD), (0, "1 files keep the rules\n"))

    def test_each_breach_is_found(self):
        """Every rule can fail."""
        for name, (old, new, words) in BREACHES.items():
            with self.subTest(name):
                self.assertIn(old, GOOD)
                code, report = self.check(GOOD.replace(old, new))
                self.assertEqual(code, 1)
                self.assertIn(words, report)

    def test_test_files_are_laid_out_well(self):
        """In test files only the layout is checked."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            path = Path(folder, "test_good.pf")
            path.write_text("module test_good\n@test\n", encoding="utf-8")
            self.assertEqual(check_style.main(["--layout", folder]), 0)
            path.write_text("module test_good \n", encoding="utf-8")
            self.assertEqual(check_style.main(["--layout", folder]), 1)

    def test_many_components_may_have_a_reason(self):
        """Fifteen components are allowed, and more with a reason."""
        few = GOOD.replace("    real(wp) :: size = 0\n", f"    real(wp) :: {MANY.rpartition(', &')[0]}\n")
        self.assertEqual(self.check(few)[0], 0)
        many = GOOD.replace("    real(wp) :: size = 0\n", f"    real(wp) :: {MANY}\n")
        self.assertEqual(self.check(many)[0], 1)
        self.assertEqual(
            self.check(many.replace("!> Thing\n", "!> Thing with much, because it is\n  !> large\n"))[0], 0
        )

    def test_inherited_components_count(self):
        """A type of two components that extends one of fourteen needs a reason."""
        few = MANY.rsplit(", &", 2)[0]
        heir = (
            "\n\n  !> Heir\n  type, extends(thing_t) :: heir_t\n    !> Both\n    real(wp) :: more = 0, other = 0\n"
            "  end type heir_t"
        )
        parent = GOOD.replace("    real(wp) :: size = 0\n", f"    real(wp) :: {few}\n")
        end = "  end type thing_t"
        self.assertIn(end, parent)
        self.assertEqual(self.check(parent)[0], 0)
        code, report = self.check(parent.replace(end, end + heir))
        self.assertEqual(code, 1)
        self.assertIn("type heir_t has 16 components", report)

    def test_large_folders_are_found(self):
        """A folder with 16 % of the lines is a breach, not one with 14 %, nor any of a small program."""
        for heights, code in (([160] + 20 * [42], 1), ([140] + 20 * [43], 0), ([16] + 20 * [4], 0)):
            with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as out:
                for i, height in enumerate(heights):
                    Path(folder, f"part{i}").mkdir()
                    for j in range(10):
                        Path(folder, f"part{i}", f"good{j}.f90").write_text("! Why\n" * height, encoding="utf-8")
                self.assertEqual(check_style.main([folder]), code)
                self.assertEqual("part0:1: 1600 of 10000 lines are more than 15%" in out.getvalue(), code == 1)

    def test_the_public_column_keeps_its_name(self):
        """The public column keeps its spelling."""
        self.assertEqual(self.check("! 'refactorisations', but not a refactorization\n" + GOOD)[0], 0)

    def test_an_empty_folder_fails(self):
        """A check without files fails."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(check_style.main([folder]), 1)


if __name__ == "__main__":
    unittest.main()
