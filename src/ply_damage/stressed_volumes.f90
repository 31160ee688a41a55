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
  use layups, only: layup_t
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
    !> Block of each ply: the number of its first ply of the laminate, the same one in all stacks; of plies of a doubler
    !> alone that of the first
    integer, allocatable, private :: block(:)
    !> Block of each ply of the plate, or of its image where it is not modelled; 0: neither is modelled
    integer, allocatable, private :: of_ply(:)
    !> Stressed volume of each block, of the full plate, (plies of the plate); 0: its fibres are not in tension
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
    integer :: i, ply, place, range(2)

    self%damage = plate%setup%ply_damage
    self%plate = product(plate%setup%plate%length)*plate%layup%thickness
    self%xt = bands%along(1)
    allocate (self%stress(size(states%trial)), self%volume(plate%layup%plies), self%failed(plate%layup%plies), &
              source=0.0_wp)
    allocate (self%block(0))
    do i = 1, size(plate%layup%laminates)
      associate (laminate => plate%layup%laminates(i))
        do ply = 1, size(laminate%plies)
          range = block_of(laminate%plies, ply)
          ! Plies of doublers have the largest numbers.
          self%block = [self%block, minval(laminate%number(range(1):range(2)))]
        end do
      end associate
    end do
    allocate (self%of_ply(plate%layup%plies), source=0)
    do i = size(plate%layup%images, 2), 1, -1
      do ply = 1, size(self%of_ply)
        place = findloc(states%number, plate%layup%images(ply, i), dim=1)
        if (place > 0) self%of_ply(ply) = self%block(place)
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

    volume = 0
    if (self%of_ply(ply) == 0) return
    associate (block => self%of_ply(ply))
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
  subroutine update(self, communicator, layup, states, plies, area)
    class(stressed_volumes_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    type(layup_t), intent(in) :: layup
    type(band_states_t), intent(in) :: states
    type(ply_t), intent(in) :: plies(:)
    !> Area of each element of this rank
    real(wp), intent(in) :: area(:)
    real(wp) :: extremes(size(self%volume), 2), volume(size(self%volume))
    type(exact_sum_t) :: sums(size(self%volume))
    integer :: i, k

    if (all(self%failed(self%block) > 0)) return
    call find_extremes(self, states, extremes)
    call communicator%maximum(extremes(:, 1))
    call communicator%maximum(extremes(:, 2))
    extremes = reshape([((maxval(extremes(layup%images(i, :), k)), i=1, size(volume)), k=1, 2)], shape(extremes))
    self%failed = max(self%failed, extremes(:, 2))
    call add_volumes(self, states, plies, area, extremes(:, 1), sums)
    volume = layup%of_full_plate(totals_of(communicator, sums))
    where (extremes(:, 1) > 0 .and. .not. self%failed > 0) self%volume = volume
  end subroutine update

  !> Largest stress of each block on this rank, and whether its fibres have failed.
  pure subroutine find_extremes(self, states, extremes)
    type(stressed_volumes_t), intent(in) :: self
    type(band_states_t), intent(in) :: states
    !> Stress, and 1 where fibres have failed, of each block, (plies of the plate, 2)
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
    if (size(self%volume) == size(self%of_ply)) return
    self%volume = of_blocks(self%volume)
    self%failed = of_blocks(self%failed)

  contains

    !> Values of version 0.2, which were stored with the first ply of each block among those of all laminates.
    pure function of_blocks(stored) result(values)
      !> One of each ply of all laminates
      real(wp), intent(in) :: stored(:)
      !> Those of the blocks
      real(wp) :: values(size(self%of_ply))
      integer :: i

      values = 0
      do i = 1, size(stored)
        values(self%block(i)) = max(values(self%block(i)), stored(i))
      end do
    end function of_blocks
  end subroutine visit
end module stressed_volumes
