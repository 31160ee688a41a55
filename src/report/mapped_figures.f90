!> Conservation in mapping to another mesh: areas and energies of interfaces, damage and energy of plies, before and
!> after, and of a plate that is cut from a larger one those before the cut.
module mapped_figures
  use archives, only: archive_t
  use exact_sums, only: exact_sum_t
  use json_text, only: json_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use rank_totals, only: totals_of
  use roundings, only: rounding
  use states, only: state_t
  use text, only: rounded_text, to_text
  implicit none
  private
  public :: mapped_figures_t

  !> Before the mapping and after it, and before a smaller plate is cut out.
  integer, parameter, public :: before_mapping = 1, after_mapping = 2, before_cutting = 3
  !> Relative loss of an area or an energy above which it is reported: the area of one of 1e6 elements, the largest
  !> number of a mesh. Round-off of the sums is a thousand times smaller.
  real(wp), parameter :: tolerance = 1.0e-6_wp

  !> Rise of the strain energy by the mapping above which it is reported, as a fraction of what was stored, the
  !> tolerance of energies in general; and the smallest that is, as a fraction of stored and dissipated energy: the
  !> strain energy of a plate at rest may be next to nothing.
  real(wp), parameter :: max_rise = 0.01_wp, fine = 1.0e-4_wp

  !> Quantities of the full plate, the same on every rank; unallocated: no mapping.
  type :: mapped_figures_t
    !> Area and energy dissipated of each interface, (zones, before and after); a third column of a plate that is cut
    real(wp), allocatable :: area(:, :), energy(:, :)
    !> Areas of all plies times the damage of fibres and of the matrix, and energy of plies, in the same columns
    real(wp), allocatable :: plies(:, :)
    !> Strain energy, before and after, and energy dissipated before
    real(wp) :: strain(2) = 0, dissipated = 0
  contains
    procedure :: note
    procedure :: is_cut
    procedure :: first_loss
    procedure :: loses_plies
    procedure :: raises_strain
    !> Lines for the log: quantities of damage, strain energy, and what is cut away.
    procedure :: line
    procedure :: energy_line
    procedure :: cut_line
    procedure :: put
    procedure :: visit
  end type mapped_figures_t

contains

  !> Stores the quantities of a state; of a plate that is cut, the first time before the cut. Collective.
  subroutine note(self, plate, state, moment)
    class(mapped_figures_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(inout) :: state
    !> before_mapping, after_mapping or before_cutting
    integer, intent(in) :: moment
    integer :: columns

    if (.not. allocated(self%plies)) then
      columns = max(moment, after_mapping)
      associate (zones => size(plate%mesh%zones))
        allocate (self%area(zones, columns), self%energy(zones, columns), self%plies(3, columns), source=0.0_wp)
      end associate
    end if
    if (moment <= after_mapping) self%strain(moment) = state%ledger%strain
    self%area(:, moment) = state%interfaces%cohesive%area(plate)
    self%energy(:, moment) = state%interfaces%cohesive%energy(plate)
    if (moment == before_mapping) self%dissipated = sum(self%energy(:, moment))
    if (.not. allocated(state%plies%bands)) return
    self%plies(:2, moment) = damage_of_plies(plate, state)
    call state%plies%total_dissipation(plate)
    self%plies(3, moment) = sum(state%plies%dissipated) + state%plies%permanent_shear
    if (moment == before_mapping) self%dissipated = self%dissipated + self%plies(3, moment)
  end subroutine note

  !> Areas of all plies times the damage of fibres and of the matrix, of the full plate. Collective.
  function damage_of_plies(plate, state) result(areas)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: state
    !> Of fibres and of the matrix
    real(wp) :: areas(2)
    type(exact_sum_t) :: fibres, matrix
    real(wp) :: damage(2)
    integer :: i, ply

    do i = 1, plate%elements%elements
      associate (stack => plate%layup%stacks(plate%layup%stack(i)), area => state%plies%bands%area(i))
        do ply = 1, size(stack%number)
          associate (states => state%plies%bands%states)
            damage = states%accepted(states%at(stack%number(ply), i))%damage
          end associate
          call fibres%add(area*damage(1))
          call matrix%add(area*damage(2))
        end do
      end associate
    end do
    areas = totals_of(plate%communicator, [fibres, matrix])*plate%mesh%multiplicity
  end function damage_of_plies

  !> True for a plate cut from a larger one.
  pure logical function is_cut(self)
    class(mapped_figures_t), intent(in) :: self

    is_cut = .false.
    if (allocated(self%plies)) is_cut = size(self%plies, 2) == before_cutting
  end function is_cut

  !> First interface with a loss of area or energy, as its zone is too small; 0: none.
  pure integer function first_loss(self)
    class(mapped_figures_t), intent(in) :: self

    first_loss = findloc(self%area(:, 2) < (1 - tolerance)*self%area(:, 1) .or. &
                    self%energy(:, 2) < (1 - tolerance)*self%energy(:, 1), .true., dim=1)
  end function first_loss

  !> True if the area of plies times their damage has fallen; their energies are no means over area where shear strains
  !> are permanent.
  pure logical function loses_plies(self)
    class(mapped_figures_t), intent(in) :: self

    loses_plies = .false.
    if (allocated(self%plies)) loses_plies = any(self%plies(:2, after_mapping) &
                                                 < (1 - tolerance)*self%plies(:2, before_mapping))
  end function loses_plies

  !> True if the strain energy has risen by more than 1 % of what was stored: mapped damage and displacements do not fit
  !> to each other, and stresses may cause further damage.
  pure logical function raises_strain(self)
    class(mapped_figures_t), intent(in) :: self

    associate (rise => self%strain(2) - self%strain(1))
      raises_strain = rise > max_rise*self%strain(1) .and. rise > fine*(self%strain(1) + self%dissipated)
    end associate
  end function raises_strain

  !> The strain energy, and what becomes of it.
  pure function energy_line(self, holds) result(line)
    class(mapped_figures_t), intent(in) :: self
    !> True: damage is held until the plate is at rest
    logical, intent(in) :: holds
    !> Before and after
    character(len=:), allocatable :: line

    line = 'Strain energy by the mapping: '//both(self%strain)
    if (holds) line = line//'; damage is held until the plate has come to rest, at the end of settle'
    line = line//'.'
  end function energy_line

  !> One line for the log.
  pure function line(self, below_plies)
    class(mapped_figures_t), intent(in) :: self
    integer, intent(in) :: below_plies(:)
    !> Before and after
    character(len=:), allocatable :: line
    integer :: i

    line = ''
    do i = 1, size(below_plies)
      line = line//'below ply '//to_text(below_plies(i))//' area '//both(self%area(i, :))//', energy '// &
             both(self%energy(i, :))//'; '
    end do
    line = 'Mapped to another mesh, before -> after: '//line//'plies: damage of fibres times area '// &
           both(self%plies(1, :))//', of the matrix '//both(self%plies(2, :))//', energy '//both(self%plies(3, :))//'.'
  end function line

  !> One line for the log of a plate cut from a larger one: the damage that is cut away; interfaces without are left
  !> out.
  pure function cut_line(self, below_plies) result(line)
    class(mapped_figures_t), intent(in) :: self
    integer, intent(in) :: below_plies(:)
    !> Quantities before the cut minus those of the plate that is cut out
    character(len=:), allocatable :: line
    integer :: i

    line = ''
    do i = 1, size(below_plies)
      if (.not. (cut_away(self%area(i, :)) > 0 .or. cut_away(self%energy(i, :)) > 0)) cycle
      line = line//'below ply '//to_text(below_plies(i))//' area '//rounded_text(cut_away(self%area(i, :)))// &
             ', energy '//rounded_text(cut_away(self%energy(i, :)))//'; '
    end do
    line = 'Cut away, and not in the energy ledger: '//line//'plies: damage of fibres times area '// &
           rounded_text(cut_away(self%plies(1, :)))//', of the matrix '//rounded_text(cut_away(self%plies(2, :)))// &
           ', energy '//rounded_text(cut_away(self%plies(3, :)))//'.'
  end function cut_line

  !> Part of a quantity that is cut away; round-off of the sums counts as nothing.
  pure real(wp) function cut_away(values)
    !> Of the part, after mapping, and before the cut
    real(wp), intent(in) :: values(before_cutting)

    cut_away = values(before_cutting) - values(before_mapping)
    if (cut_away < rounding*values(before_cutting)) cut_away = 0
  end function cut_away

  !> Both values.
  pure function both(values) result(text)
    !> Before and after, and before a cut
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: text

    text = rounded_text(values(1))//' -> '//rounded_text(values(2))
  end function both

  !> Adds them to the summary.
  subroutine put(self, json, below_plies)
    class(mapped_figures_t), intent(in) :: self
    type(json_t), intent(inout) :: json
    integer, intent(in) :: below_plies(:)
    integer :: i

    if (.not. allocated(self%plies)) return
    call json%open_object('mapping')
    call json%open_list('interfaces')
    do i = 1, size(below_plies)
      call json%open_object('')
      call json%put('ply_above', below_plies(i))
      call put_both('area', self%area(i, :))
      call put_both('energy', self%energy(i, :))
      call json%close()
    end do
    call json%close()
    call put_both('fibre_damage_area', self%plies(1, :))
    call put_both('matrix_damage_area', self%plies(2, :))
    call put_both('energy_ply_damage', self%plies(3, :))
    call json%put('energy_strain_before', self%strain(1))
    call json%put('energy_strain_after', self%strain(2))
    call json%close()

  contains

    !> Adds both values.
    subroutine put_both(name, values)
      !> Their name
      character(len=*), intent(in) :: name
      !> Before and after, and before a cut
      real(wp), intent(in) :: values(:)

      call json%put(name//'_before', values(1))
      call json%put(name//'_after', values(2))
      if (self%is_cut()) call json%put(name//'_cut_away', cut_away(values))
    end subroutine put_both
  end subroutine put

  !> Saves or loads the quantities.
  subroutine visit(self, archive)
    class(mapped_figures_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    logical :: known

    known = allocated(self%plies)
    call archive%item('mapping/known', known)
    if (.not. known) return
    call archive%item('mapping/area', self%area)
    call archive%item('mapping/energy', self%energy)
    call archive%item('mapping/plies', self%plies)
    call archive%item('mapping/strain_before', self%strain(1))
    call archive%item('mapping/strain_after', self%strain(2))
    call archive%item('mapping/dissipated', self%dissipated)
  end subroutine visit
end module mapped_figures
