!> Tensile strengths of fibres that are drawn once by position, theory (M33): the plies are divided into squares, and
!> the strength of a square is a random number of the seed, the ply and the place of the square. A strength is thus no
!> state: restarts, other ranks, other layers and another mesh find the same one.
module drawn_strengths
  use band_states, only: band_states_t
  use crack_bands, only: crack_band_t
  use kinds, only: long, wp
  use composite_plates, only: composite_plate_t
  use murmur_hashes, only: murmur3, uniform_of
  use plies, only: ply_t
  use ply_damage_parameters, only: ply_damage_t
  implicit none
  private
  public :: drawn_strengths_t, new_drawn_strengths, square_strength, squares_between

  !> Strengths of the plies of this rank's elements.
  type :: drawn_strengths_t
    !> Tensile strength over XT, at the places of the states
    real(wp), allocatable :: factor(:)
  contains
    procedure :: law
  end type drawn_strengths_t

contains

  !> Strengths of the plies of a plate. An element has that of its weakest square.
  function new_drawn_strengths(plate, plies, states, joined) result(self)
    type(composite_plate_t), intent(in) :: plate
    !> Plies of the different laminates, one after the other
    type(ply_t), intent(in) :: plies(:)
    !> States of the plies of all elements
    type(band_states_t), intent(in) :: states
    !> True along x and y for an element that shares its damage with that beyond its side, (2, elements)
    logical, intent(in) :: joined(:, :)
    type(drawn_strengths_t) :: self
    real(wp) :: volume
    integer :: element, ply, squares(2, 2)

    allocate (self%factor(size(states%trial)), source=1.0_wp)
    associate (damage => plate%setup%ply_damage)
      do element = 1, size(joined, 2)
        squares = squares_of(plate, element, joined(:, element))
        !GCC$ NOVECTOR
        do ply = states%range(1, element), states%range(2, element)
          volume = damage%strength_length**2*(plies(ply)%z_bottom - plies(ply)%z_top)
          self%factor(states%offset(element) + ply) = square_strength(damage, volume, &
            weakest_of(damage%strength_seed, states%number(ply), squares))
        end do
      end do
    end associate
  end function new_drawn_strengths

  !> Law of a ply with its smallest strength in the elements of this rank.
  pure type(crack_band_t) function law(self, band, states, ply)
    class(drawn_strengths_t), intent(in) :: self
    !> Its law with XT
    type(crack_band_t), intent(in) :: band
    !> States of the plies of all elements
    type(band_states_t), intent(in) :: states
    !> The ply, among those of the different laminates
    integer, intent(in) :: ply
    real(wp) :: smallest
    integer :: element

    smallest = 1
    do element = 1, size(states%offset)
      if (ply >= states%range(1, element) .and. ply <= states%range(2, element)) &
        smallest = min(smallest, self%factor(states%offset(element) + ply))
    end do
    law = band
    law%along(1) = law%along(1)*smallest
  end function law

  !> Strength of a square over XT. Weibull's distribution in which XT is the mean of specimens of the reference volume.
  pure real(wp) function square_strength(damage, volume, hash) result(factor)
    type(ply_damage_t), intent(in) :: damage
    !> Volume of the square
    real(wp), intent(in) :: volume
    !> Its random number
    integer(long), intent(in) :: hash

    associate (m => damage%weibull_modulus)
      factor = (-log(uniform_of(hash))*damage%reference_volume/volume)**(1/m)/gamma(1 + 1/m)
    end associate
  end function square_strength

  !> Random number of the weakest square: the largest one, as strengths fall with it.
  pure integer(long) function weakest_of(seed, ply, squares) result(hash)
    !> Of the deck
    integer, intent(in) :: seed
    integer, intent(in) :: ply
    !> First and last column of squares, then of rows
    integer, intent(in) :: squares(2, 2)
    integer :: i, j

    hash = 0
    do j = squares(1, 2), squares(2, 2)
      do i = squares(1, 1), squares(2, 1)
        hash = max(hash, murmur3(int([ply, i, j], long), int(seed, long)))
      end do
    end do
  end function weakest_of

  !> The squares of an element; elements that share their damage have one strength, that of all their squares.
  pure function squares_of(plate, element, joined) result(squares)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: element
    !> True along x and y if it shares its damage with the element beyond its side
    logical, intent(in) :: joined(2)
    !> First and last column, then row
    integer :: squares(2, 2)
    real(wp) :: other(2), ends(2)
    integer :: place(2), side(2), i

    associate (mesh => plate%mesh, setup => plate%setup)
      place = mesh%place_of(mesh%element_cell(plate%distribution%elements(element)))
      side = mesh%struck_side(place)
      do i = 1, 2
        ends = mesh%along(i)%ends(place(i))
        if (joined(i)) then
          other = mesh%along(i)%ends(place(i) + side(i))
          ends = [min(ends(1), other(1)), max(ends(2), other(2))]
        end if
        squares(:, i) = squares_between(ends + setup%initial%cut_at(i), setup%ply_damage%strength_length)
      end do
    end associate
  end function squares_of

  !> Squares of a line whose middles lie in an interval; if there are none, the one that contains its middle. Intervals
  !> one after the other thus have all squares of the line, each in one of them if no interval is shorter than a square.
  pure function squares_between(ends, length) result(squares)
    !> The interval
    real(wp), intent(in) :: ends(2)
    !> Side of a square
    real(wp), intent(in) :: length
    !> First and last; the square 0 begins at the coordinate 0
    integer :: squares(2)
    !> Round-off of an edge on the middle of a square, in squares
    real(wp), parameter :: same = 1.0e-6_wp

    squares = ceiling(ends/length - 0.5_wp - same) - [0, 1]
    if (squares(2) < squares(1)) squares = floor(sum(ends)/2/length + same)
  end function squares_between
end module drawn_strengths
