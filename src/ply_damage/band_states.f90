!> Damage of the softening plies of all elements: one state per ply and element.
module band_states
  use archives, only: archive_t
  use crack_bands, only: band_state_t, is_damaged
  use field_mappings, only: ply_field, ply_shear_field
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use ply_damage_parameters, only: energy_modes, failure_modes, matrix_compression, matrix_cracking, &
                                   matrix_crushing, matrix_tension
  implicit none
  private
  public :: band_states_t, new_band_states

  !> States of the plies of one element after the other.
  type :: band_states_t
    !> The last accepted state, and the trial
    type(band_state_t), allocatable :: accepted(:), trial(:)
    !> First and last ply of each element among those of the different laminates one after the other, (2, elements)
    integer, allocatable :: range(:, :)
    !> The state of a ply of an element has this index plus the index of the ply among these, (elements)
    integer, allocatable :: offset(:)
    !> Number of each of these plies among those of the plate
    integer, allocatable :: number(:)
    !> Laminate of each element
    integer, allocatable, private :: laminate(:)
    !> Index of a ply of the plate in each laminate; 0: it has not this ply, (plies, laminates)
    integer, allocatable, private :: entry(:, :)
  contains
    procedure :: accept
    procedure :: at
    procedure :: damaged
    procedure :: failed_modes
    procedure :: visit
  end type band_states_t

contains

  !> Plies without damage.
  pure function new_band_states(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(band_states_t) :: self
    integer :: range(2, plate%elements%elements), i, place, next

    allocate (self%laminate(size(range, 2)), self%number(0))
    allocate (self%entry(plate%layup%plies, size(plate%layup%laminates)), source=0)
    do i = 1, size(plate%layup%laminates)
      associate (numbers => plate%layup%laminates(i)%number)
        do place = 1, size(numbers)
          self%entry(numbers(place), i) = size(self%number) + place
        end do
        self%number = [self%number, numbers]
      end associate
    end do
    do i = 1, size(range, 2)
      self%laminate(i) = plate%mesh%layers(plate%layup%stack(i))%laminate
      associate (numbers => plate%layup%stacks(plate%layup%stack(i))%number)
        range(:, i) = self%entry(numbers([1, size(numbers)]), self%laminate(i))
      end associate
    end do
    self%range = range
    allocate (self%offset(size(range, 2)), self%accepted(sum(range(2, :) - range(1, :) + 1)))
    next = 1
    do i = 1, size(self%offset)
      self%offset(i) = next - range(1, i)
      next = next + range(2, i) - range(1, i) + 1
    end do
    self%trial = self%accepted
  end function new_band_states

  !> Index of the state of a ply of an element.
  pure integer function at(self, ply, element)
    class(band_states_t), intent(in) :: self
    !> Number of the ply, and element of this rank whose cell has it
    integer, intent(in) :: ply, element

    at = self%offset(element) + self%entry(ply, self%laminate(element))
  end function at

  !> Accepts the trial states of one element.
  pure subroutine accept(self, element)
    class(band_states_t), intent(inout) :: self
    integer, intent(in) :: element

    associate (first => self%offset(element) + self%range(1, element), &
               last => self%offset(element) + self%range(2, element))
      self%accepted(first:last) = self%trial(first:last)
    end associate
  end subroutine accept

  !> True if a ply of an element has damage in the accepted state.
  pure logical function damaged(self, element)
    class(band_states_t), intent(in) :: self
    integer, intent(in) :: element

    damaged = any(is_damaged(self%accepted(self%offset(element) + self%range(1, element): &
                                           self%offset(element) + self%range(2, element))))
  end function damaged

  !> Failed modes of a ply of an element in the trial: the ply has failed where its stress is zero, its matrix by
  !> crushing where it has dissipated more energy in transverse compression than in tension.
  pure function failed_modes(self, ply, element) result(failed)
    class(band_states_t), intent(in) :: self
    !> Ply and element of this rank that has it
    integer, intent(in) :: ply, element
    !> True for failed modes
    logical :: failed(failure_modes)
    integer :: at

    at = self%at(ply, element)
    associate (state => self%trial(at))
      failed = [state%damage(1) >= 1, state%damage(2) >= 1, state%damage(2) >= 1]
      if (.not. failed(matrix_cracking)) return
      failed(matrix_crushing) = state%dissipated(matrix_compression) > state%dissipated(matrix_tension)
      failed(matrix_cracking) = .not. failed(matrix_crushing)
    end associate
  end function failed_modes

  !> Saves or loads the accepted states. Collective.
  subroutine visit(self, archive, plate)
    class(band_states_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    integer, parameter :: numbers = 3 + energy_modes
    real(wp), dimension(:, :), allocatable :: table, strains, closed, kinked, cracked
    integer :: element, entry, ply, i

    ! A column has all plies of the plate, so that, when an element is split into layers, each layer can read its
    ! plies from the column of the undivided element, and an element beyond the modelled part from that of its image.
    allocate (table(numbers*plate%layup%plies, size(self%offset)), strains(2*plate%layup%plies, size(self%offset)), &
              closed(2*plate%layup%plies, size(self%offset)), kinked(plate%layup%plies, size(self%offset)), &
              cracked(plate%layup%plies, size(self%offset)), &
              source=0.0_wp)
    do element = 1, size(self%offset)
      do entry = self%range(1, element), self%range(2, element)
        associate (state => self%accepted(self%offset(element) + entry), &
                   images => plate%layup%images(self%number(entry), :))
          do i = 1, size(images)
            ply = images(i)
            table((ply - 1)*numbers + 1:ply*numbers, element) = [state%damage, state%shear_damage, state%dissipated]
            strains(2*ply - 1:2*ply, element) = [state%permanent, state%accumulated]
            closed(2*ply - 1:2*ply, element) = state%closed
          end do
          kinked(images, element) = state%kinked
          cracked(images, element) = state%strengthened
        end associate
      end do
    end do
    associate (owned => plate%distribution%elements, elements => plate%mesh%elements(), &
               damage => plate%setup%ply_damage)
      call archive%field('ply_failure/crack_bands', owned, elements, table, ply_field)
      if (damage%permanent_shear) &
        call archive%field('ply_failure/permanent_shear', owned, elements, strains, ply_shear_field)
      if (damage%crack_closure) &
        call archive%field('ply_failure/closed_cracks', owned, elements, closed, ply_field)
      if (damage%kinking) &
        call archive%field('ply_failure/kinked_fibres', owned, elements, kinked, ply_field)
      if (plate%setup%has_rates()) &
        call archive%field('ply_failure/strengthened', owned, elements, cracked, ply_field)
    end associate
    if (.not. archive%loading) return
    do element = 1, size(self%offset)
      do entry = self%range(1, element), self%range(2, element)
        ply = self%number(entry)
        associate (values => table((ply - 1)*numbers + 1:ply*numbers, element), &
                   shear => strains(2*ply - 1:2*ply, element))
          self%accepted(self%offset(element) + entry) = &
            band_state_t(damage=values(1:2), shear_damage=values(3), dissipated=values(4:), permanent=shear(1), &
                         accumulated=shear(2), closed=closed(2*ply - 1:2*ply, element), kinked=kinked(ply, element), &
                         strengthened=cracked(ply, element))
        end associate
      end do
    end do
    self%trial = self%accepted
  end subroutine visit
end module band_states
