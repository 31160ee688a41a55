"""Shows that the check finds names that are not reached, and raises no false alarm."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_reach

SHAPES = """\
!> Shapes.
module shapes
  implicit none
  private
  public :: shape_t, square_t, disc_t, area_of, measure, longest, new_disc, operator(+), halved

  !> A shape
  type, abstract :: shape_t
    !> Name
    character(len=:), allocatable :: name
  contains
    procedure(area), deferred :: area
    procedure :: label
  end type shape_t

  type, extends(shape_t) :: square_t
    real :: side = 0
  contains
    procedure :: area => area_of_square
  end type square_t

  type, extends(shape_t) :: disc_t
    real :: radius = 0
  contains
    procedure :: area => area_of_disc
    procedure :: grow
    procedure, private :: grow_real, grow_integer
    generic :: enlarge => grow_real, grow_integer
    final :: forget
  end type disc_t

  abstract interface
    real function area(self)
      import :: shape_t
      class(shape_t), intent(in) :: self
    end function area
  end interface

  interface measure
    module procedure measure_one, measure_many
  end interface measure

  interface operator(+)
    module procedure joined
  end interface

contains

  type(disc_t) function joined(left, right)
    type(disc_t), intent(in) :: left, right
    joined%radius = halved(left%radius + right%radius)
  end function joined

  real function halved(size)
    real, intent(in) :: size
    halved = size/2
  end function halved

  subroutine forget(disc)
    type(disc_t), intent(inout) :: disc
    disc%radius = halved(disc%radius)
  end subroutine forget

  real function area_of(shape)
    class(shape_t), intent(in) :: shape
    area_of = shape%area()
  end function area_of

  real function area_of_square(self)
    class(square_t), intent(in) :: self
    area_of_square = self%side**2
  end function area_of_square

  real function area_of_disc(self)
    class(disc_t), intent(in) :: self
    area_of_disc = 3.14*self%radius**2
  end function area_of_disc

  function label(self)
    class(shape_t), intent(in) :: self
    character(len=:), allocatable :: label
    label = 'not a call of longest(shapes): '//self%name ! nor is longest(shapes)
  end function label

  subroutine grow(self)
    class(disc_t), intent(inout) :: self
    self%radius = 2*self%radius
  end subroutine grow

  subroutine grow_real(self, factor)
    class(disc_t), intent(inout) :: self
    real, intent(in) :: factor
    self%radius = factor*self%radius
  end subroutine grow_real

  subroutine grow_integer(self, factor)
    class(disc_t), intent(inout) :: self
    integer, intent(in) :: factor
    self%radius = factor*self%radius
  end subroutine grow_integer

  real function measure_one(shape)
    class(shape_t), intent(in) :: shape
    measure_one = area_of(shape)
  end function measure_one

  real function measure_many(shapes)
    class(shape_t), intent(in) :: shapes(:)
    measure_many = area_of(shapes(1))
  end function measure_many

  integer function longest(shapes)
    class(shape_t), intent(in) :: shapes(:)
    longest = size(shapes)
  end function longest

  type(disc_t) function new_disc()
    new_disc%radius = 1
  end function new_disc
end module shapes
"""

PLANTS = """\
!> Plants.
module plants
  use shapes, only: disc_t
  implicit none
  private
  public :: plant_t

  type :: plant_t
    type(disc_t) :: leaf
  contains
    procedure :: grow
  end type plant_t

contains

  subroutine grow(self)
    class(plant_t), intent(inout) :: self
  end subroutine grow
end module plants
"""

MAIN = """\
!> All is reached.
program all
  use plants, only: plant_t
  use shapes, only: disc_t, square_t, how_large => measure, longest, make => new_disc
  implicit none
  type(plant_t) :: plant
  type(disc_t), allocatable :: discs(:)

  call plant%grow()
  call inner(plant)

contains

  subroutine inner(plant)
    type(plant_t), intent(inout) :: plant
    real :: area

    area = how_large(make())
    associate (leaf => plant%leaf)
      call leaf%grow()
      if (len(leaf%label()) > 0) call discs(longest([leaf]))%enlarge(2)
    end associate
  end subroutine inner
end program all
"""

# name of the case: (text in MAIN, its replacement, names that are reported)
CASES = {
    "all": ("", "", []),
    "a public procedure": ("longest([leaf])", "1", ["longest"]),
    "a variable of that name is no call": (
        "    real :: area\n",
        "    real :: area\n    integer :: longest(1)\n",
        ["longest"],
    ),
    "a text and a comment are no calls": (
        "longest([leaf])",
        "len('longest([leaf])')",  # longest([leaf])
        ["longest"],
    ),
    "a renamed function": ("make()", "plant%leaf", ["new_disc"]),
    "a binding, though another type has one of the name": ("      call leaf%grow()\n", "", ["disc_t%grow"]),
    "that of the other type": ("  call plant%grow()\n", "", ["plant_t%grow"]),
    "bindings behind a generic one": ("%enlarge(2)", "%grow()", ["disc_t%grow_integer", "disc_t%grow_real"]),
    "an inherited binding": ("len(leaf%label()) > 0", ".true.", ["shape_t%label"]),
    "a deferred binding and all behind a generic name": (
        "how_large(make())",
        "make()",
        ["area_of", "measure", "shape_t%area"],
    ),
    "names in a procedure that is not reached": (
        "  call inner(plant)\n",
        "",
        [
            "area_of",
            "disc_t%grow",
            "disc_t%grow_integer",
            "disc_t%grow_real",
            "longest",
            "measure",
            "new_disc",
            "shape_t%area",
            "shape_t%label",
        ],
    ),
    "a type that cannot be decided reaches all of the name": (
        "call leaf%grow()",
        "call choose(leaf)%grow()",
        [],
    ),
}


class ReachTest(unittest.TestCase):
    """The check on three small files."""

    def check(self, main, exceptions=()):
        """Run the check; return its exit code and report."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as out:
            for name, text in (("shapes", SHAPES), ("plants", PLANTS), ("main", main)):
                Path(folder, f"{name}.f90").write_text(text, encoding="utf-8")
            code = check_reach.main([folder], dict.fromkeys(exceptions, "a reason"))
        return code, out.getvalue()

    def test_cases(self):
        """Unreached names are reported, and no others."""
        for name, (old, new, missing) in CASES.items():
            with self.subTest(name):
                self.assertIn(old, MAIN)
                code, report = self.check(MAIN.replace(old, new) if old else MAIN)
                found = [line.split(" is not")[0].split(": ")[1] for line in report.splitlines() if " is not" in line]
                self.assertEqual(found, missing)
                self.assertEqual(code, 1 if missing else 0)

    def test_exceptions(self):
        """A needed exception passes, an unneeded one fails."""
        main = MAIN.replace("longest([leaf])", "1")
        self.assertEqual(self.check(main, ["shapes: longest"])[0], 0)
        code, report = self.check(MAIN, ["shapes: longest"])
        self.assertEqual(code, 1)
        self.assertIn("shapes: longest is among the exceptions but is reached", report)

    def test_an_empty_folder_fails(self):
        """A check without files fails."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(check_reach.main([folder], {}), 1)


if __name__ == "__main__":
    unittest.main()
