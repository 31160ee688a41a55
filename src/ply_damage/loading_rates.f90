!> Strain rates of plies, by which the strengths of their matrix increase, theory (M31) and (M32).
!>
!> The rate is a mean over the loading so far, weighted by the strain, which needs no time scale: of each ply in an
!> element the largest strain s, the integral of s over its growth, and that over the time of the growth are kept.
!> Vibration below the largest strain does not count, and the strength does not change while a ply unloads.
module loading_rates
  use archives, only: archive_t
  use crack_bands, only: band_strains_t, crack_band_t
  use field_mappings, only: ply_field
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use ply_strains, only: strain_moments_t, strains_of_ply
  use plies, only: ply_t
  implicit none
  private
  public :: loading_rates_t, new_loading_rates, strengthened_at

  !> Values of a ply in an element.
  integer, parameter :: values = 3, largest = 1, growth = 2, duration = 3

  !> The rates of the plies of this rank's elements, at the places of their states.
  type :: loading_rates_t
    !> Length of the step of the trial; 0: it is not in time
    real(wp) :: step = 0
    !> False: the load is quasi-static, and its rates do not count
    logical :: counts = .false.
    !> Largest strain, its integral over growth, and over time, of the last accepted state and of the trial, (values,
    !> states)
    real(wp), allocatable, private :: accepted(:, :), trial(:, :)
  contains
    procedure :: find_factor
    procedure :: accept
    procedure :: visit
  end type loading_rates_t

contains

  !> Rates of plies without load.
  pure function new_loading_rates(plate, states) result(self)
    type(composite_plate_t), intent(in) :: plate
    !> Number of plies of all elements
    integer, intent(in) :: states
    type(loading_rates_t) :: self

    self%counts = plate%setup%counts_rates()
    allocate (self%accepted(values, states), source=0.0_wp)
    self%trial = self%accepted
  end function new_loading_rates

  !> Factor of the matrix strengths of a ply of an element in the trial.
  pure subroutine find_factor(self, at, ply, band, moments, factor)
    class(loading_rates_t), intent(inout) :: self
    !> Place of its state
    integer, intent(in) :: at
    type(ply_t), intent(in) :: ply
    !> Its law
    type(crack_band_t), intent(in) :: band
    !> Strains of the element, or their means over those that share its state
    type(strain_moments_t), intent(in) :: moments
    !> The factor, at least 1
    real(wp), intent(out) :: factor
    type(band_strains_t) :: strains
    real(wp) :: strain, rate

    factor = 1
    if (.not. self%counts) return
    strains = strains_of_ply(ply, moments)
    associate (old => self%accepted(:, at), new => self%trial(:, at))
      strain = sqrt(max(0.0_wp, strains%square(2)) + strains%shear_square)
      new = old
      if (strain > old(largest)) then
        new(largest) = strain
        if (self%step > 0) then
          new(growth) = old(growth) + (strain**2 - old(largest)**2)/2
          new(duration) = old(duration) + (strain + old(largest))/2*self%step
        end if
      end if
      if (.not. new(duration) > 0) return
      rate = new(growth)/new(duration)
      factor = strengthened_at(band%rate_gain, band%reference_rate, rate)
    end associate
  end subroutine find_factor

  !> Factor of matrix strengths at a strain rate, at least 1.
  elemental real(wp) function strengthened_at(gain, reference, rate) result(factor)
    !> Gain per decade, rate at which the strengths hold, and the rate
    real(wp), intent(in) :: gain, reference, rate

    factor = 1
    if (rate > reference) factor = 1 + gain*log10(rate/reference)
  end function strengthened_at

  !> Accepts the trial.
  pure subroutine accept(self)
    class(loading_rates_t), intent(inout) :: self

    if (self%counts) self%accepted = self%trial
  end subroutine accept

  !> Saves or loads the accepted rates. Collective.
  subroutine visit(self, archive, plate, range, offset, number)
    class(loading_rates_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    !> First and last ply of each element, and what its number is less than the place of its state
    integer, intent(in) :: range(:, :), offset(:)
    !> Number of each ply among those of the plate
    integer, intent(in) :: number(:)
    real(wp), allocatable :: table(:, :)
    integer :: element, ply, row, i

    ! A column has all plies of the plate, with those of images, as those of the states.
    allocate (table(values*plate%layup%plies, size(offset)), source=0.0_wp)
    do element = 1, size(offset)
      do ply = range(1, element), range(2, element)
        do i = 1, size(plate%layup%images, 2)
          row = values*(plate%layup%images(number(ply), i) - 1)
          table(row + 1:row + values, element) = self%accepted(:, offset(element) + ply)
        end do
      end do
    end do
    call archive%field('ply_failure/loading_rates', plate%distribution%elements, plate%mesh%elements(), table, &
                       ply_field)
    if (.not. archive%loading) return
    do element = 1, size(offset)
      do ply = range(1, element), range(2, element)
        row = values*(number(ply) - 1)
        self%accepted(:, offset(element) + ply) = table(row + 1:row + values, element)
      end do
    end do
    self%trial = self%accepted
  end subroutine visit
end module loading_rates
