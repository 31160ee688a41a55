!> Size of the stressed volume in the tensile strength of fibres: the weakest link, theory (M30) (W. Weibull, Journal of
!> Applied Mechanics 18 (1951) 293-297; M. R. Wisnom, B. Khan, S. R. Hallett, Composite Structures 84 (2008) 21-28).
!>
!> A block of plies of one material and angle, which carry their load together, has one volume. It is that of the last
!> accepted state, and remains as it is from the first failure of fibres of the block on: strengths are constant while
!> fibres soften, so that they dissipate G_ft.
module stressed_volumes
  use archives, only: archive_t
  use band_states, only: band_states_t
  use crack_band_limits, only: strain_of_stress
  use crack_bands, only: crack_band_t
  use communicators, only: communicator_t
  use exact_sums, only: exact_sum_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use plies, only: ply_t
  use ply_blocks, only: block_of
  use ply_damage_parameters, only: fibre_tension, ply_damage_t
  use rank_totals, only: totals_of
  implicit none
  private
  public :: stressed_volumes_t, new_stressed_volumes, factor_of

  !> Part of the volume of a block whose neglect changes nothing: stresses below the share that contributes less are
  !> taken as zero.
  real(wp), parameter :: neglected = 1.0e-12_wp

  !> Volumes of the blocks of a laminate.
  type :: stressed_volumes_t
    !> Undamaged tensile stress along the fibres of each ply of each element in the trial, at the places of the states
    real(wp), allocatable :: stress(:)
    !> Weibull modulus, and the volume for which XT holds
    type(ply_damage_t), private :: damage
    !> Volume of the plate
    real(wp), private :: plate = 0
    !> Strength of each ply for that volume
    real(wp), allocatable, private :: xt(:)
    !> Number of each ply among those of the plate
    integer, allocatable, private :: number(:)
    !> First ply of the block of each ply, the same one in all laminates
    integer, allocatable, private :: block(:)
    !> Stressed volume of the block that begins with each ply, of the full plate; 0: its fibres are not in tension
    real(wp), allocatable, private :: volume(:)
    !> 1: fibres of the block have failed, and its volume is constant, otherwise 0
    real(wp), allocatable, private :: failed(:)
  contains
    procedure :: smallest_strain
    procedure :: factor
    procedure :: strengths
    procedure, private :: smallest_share
    procedure :: volume_at_failure
    procedure :: clear
    procedure :: update
    procedure :: visit
  end type stressed_volumes_t

contains

  !> Volumes of plies without load.
  function new_stressed_volumes(plate, bands, states) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(crack_band_t), intent(in) :: bands(:)
    !> States of the plies of all elements
    type(band_states_t), intent(in) :: states
    type(stressed_volumes_t) :: self
    integer :: i, ply, entry, range(2)

    self%damage = plate%setup%ply_damage
    self%plate = product(plate%setup%plate%length)*plate%layup%thickness
    self%xt = bands%along(1)
    allocate (self%stress(size(states%trial)), self%volume(size(bands)), self%failed(size(bands)), source=0.0_wp)
    allocate (self%block(size(bands)))
    self%number = states%number
    entry = 0
    do i = 1, size(plate%layup%laminates)
      do ply = 1, size(plate%layup%laminates(i)%plies)
        entry = entry + 1
        range = block_of(plate%layup%laminates(i)%plies, ply)
        self%block(entry) = findloc(states%number, plate%layup%laminates(i)%number(range(1)), dim=1)
      end do
    end do
  end function new_stressed_volumes

  !> Smallest stress, relative to the largest of a block, that contributes to its volume.
  pure real(wp) function smallest_share(self) result(share)
    class(stressed_volumes_t), intent(in) :: self

    share = neglected**(1/self%damage%weibull_modulus)
  end function smallest_share

  !> A strain below which no ply contributes to the volume of a block, in the measure of `onset_strain`.
  pure real(wp) function smallest_strain(self, bands) result(strain)
    class(stressed_volumes_t), intent(in) :: self
    type(crack_band_t), intent(in) :: bands(:)
    real(wp) :: share
    integer :: i

    share = self%smallest_share()*min(1.0_wp, factor_of(self%damage, self%plate))
    strain = minval([(strain_of_stress(bands(i), share*self%xt(i)), i=1, size(bands))])
  end function smallest_strain

  !> Tensile strengths of the plies.
  pure function strengths(self)
    class(stressed_volumes_t), intent(in) :: self
    !> One a ply
    real(wp) :: strengths(size(self%xt))
    integer :: i

    strengths = [(self%xt(i)*self%factor(i), i=1, size(self%xt))]
  end function strengths

  !> Tensile strength of a ply over XT; 1 as long as its fibres have not been in tension.
  pure real(wp) function factor(self, ply)
    class(stressed_volumes_t), intent(in) :: self
    integer, intent(in) :: ply

    factor = 1
    associate (volume => self%volume(self%block(ply)))
      if (volume > 0) factor = factor_of(self%damage, volume)
    end associate
  end function factor

  !> Tensile strength over XT of fibres with a stressed volume.
  pure real(wp) function factor_of(damage, volume) result(factor)
    type(ply_damage_t), intent(in) :: damage
    !> The volume
    real(wp), intent(in) :: volume

    factor = 1
    if (damage%weibull_modulus > 0) factor = (damage%reference_volume/volume)**(1/damage%weibull_modulus)
  end function factor_of

  !> Stressed volume of the block of a ply when its fibres failed first; 0: they have not failed.
  pure real(wp) function volume_at_failure(self, ply) result(volume)
    class(stressed_volumes_t), intent(in) :: self
    integer, intent(in) :: ply

    associate (block => self%block(findloc(self%number, ply, dim=1)))
      volume = self%failed(block)*self%volume(block)
    end associate
  end function volume_at_failure

  !> Sets the stresses of some elements to zero.
  pure subroutine clear(self, states, first, last)
    class(stressed_volumes_t), intent(inout) :: self
    type(band_states_t), intent(in) :: states
    !> First and last element of this rank
    integer, intent(in) :: first, last

    self%stress(states%offset(first) + states%range(1, first):states%offset(last) + states%range(2, last)) = 0
  end subroutine clear

  !> Volumes of the accepted state. Collective.
  subroutine update(self, communicator, states, plies, area, multiplicity)
    class(stressed_volumes_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    type(band_states_t), intent(in) :: states
    type(ply_t), intent(in) :: plies(:)
    !> Area of each element of this rank
    real(wp), intent(in) :: area(:)
    !> Images of the modelled part in the full plate
    integer, intent(in) :: multiplicity
    real(wp), allocatable :: extremes(:, :)
    type(exact_sum_t), allocatable :: sums(:)
    integer :: i

    if (all(self%failed(self%block) > 0)) return
    allocate (extremes(size(plies), 2))
    call find_extremes(self, states, extremes)
    call communicator%maximum(extremes(:, 1))
    call communicator%maximum(extremes(:, 2))
    self%failed = max(self%failed, extremes(:, 2))
    allocate (sums(size(plies)))
    call add_volumes(self, states, plies, area, extremes(:, 1), sums)
    associate (open => pack([(i, i=1, size(plies))], extremes(:, 1) > 0 .and. .not. self%failed > 0))
      self%volume(open) = totals_of(communicator, sums(open))*multiplicity
    end associate
  end subroutine update

  !> Largest stress of each block on this rank, and whether its fibres have failed.
  pure subroutine find_extremes(self, states, extremes)
    type(stressed_volumes_t), intent(in) :: self
    type(band_states_t), intent(in) :: states
    !> Stress, and 1 where fibres have failed, of the blocks that begin with each ply, (plies, 2)
    real(wp), intent(out) :: extremes(:, :)
    integer :: element, ply

    extremes = 0
    do element = 1, size(states%offset)
      do ply = states%range(1, element), states%range(2, element)
        associate (at => states%offset(element) + ply, block => self%block(ply))
          if (self%failed(block) > 0) cycle
          extremes(block, 1) = max(extremes(block, 1), self%stress(at))
          if (states%accepted(at)%dissipated(fibre_tension) > 0) extremes(block, 2) = 1
        end associate
      end do
    end do
  end subroutine find_extremes

  !> Adds the volumes of the plies of this rank's elements, weighted by their stresses.
  pure subroutine add_volumes(self, states, plies, area, largest, sums)
    type(stressed_volumes_t), intent(in) :: self
    type(band_states_t), intent(in) :: states
    type(ply_t), intent(in) :: plies(:)
    !> Area of each element
    real(wp), intent(in) :: area(:)
    !> Largest stress of each block
    real(wp), intent(in) :: largest(:)
    !> Sum of each block
    type(exact_sum_t), intent(inout) :: sums(:)
    real(wp) :: share
    integer :: element, ply

    share = self%smallest_share()
    do element = 1, size(states%offset)
      do ply = states%range(1, element), states%range(2, element)
        associate (stress => self%stress(states%offset(element) + ply), block => self%block(ply))
          if (self%failed(block) > 0 .or. .not. stress > share*largest(block)) cycle
          call sums(block)%add(area(element)*(plies(ply)%z_bottom - plies(ply)%z_top) &
                               *(stress/largest(block))**self%damage%weibull_modulus)
        end associate
      end do
    end do
  end subroutine add_volumes

  !> Saves or loads the volumes.
  subroutine visit(self, archive)
    class(stressed_volumes_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('ply_failure/stressed_volumes', self%volume)
    call archive%item('ply_failure/failed_fibres', self%failed)
  end subroutine visit
end module stressed_volumes
