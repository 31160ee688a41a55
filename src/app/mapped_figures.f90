!> Conservation in mapping to another mesh: areas and energies of interfaces, damage and energy of plies, before and
!> after.
module mapped_figures
  use archives, only: archive_t
  use exact_sums, only: exact_sum_t
  use json_text, only: json_t
  use kinds, only: wp
  use models, only: model_t
  use rank_totals, only: totals_of
  use states, only: state_t
  use text, only: rounded_text, to_text
  implicit none
  private
  public :: mapped_figures_t

  !> Before the mapping and after it.
  integer, parameter, public :: before_mapping = 1, after_mapping = 2
  !> Relative loss of an area or an energy above which it is reported: the area of one of 1e6 elements, the largest
  !> number of a mesh. Round-off of the sums is a thousand times smaller.
  real(wp), parameter :: tolerance = 1.0e-6_wp

  !> Rise of the strain energy by the mapping above which it is reported, as a fraction of what was stored, the
  !> tolerance of energies in general; and the smallest that is, as a fraction of stored and dissipated energy: the
  !> strain energy of a plate at rest may be next to nothing.
  real(wp), parameter :: max_rise = 0.01_wp, fine = 1.0e-4_wp

  !> Quantities of the full plate, the same on every rank; unallocated: no mapping.
  type :: mapped_figures_t
    !> Area and energy dissipated of each interface, (zones, before and after)
    real(wp), allocatable :: area(:, :), energy(:, :)
    !> Areas of all plies times the damage of fibres and of the matrix, and energy of plies, (3, before and after)
    real(wp), allocatable :: plies(:, :)
    !> Strain energy, before and after, and energy dissipated before
    real(wp) :: strain(2) = 0, dissipated = 0
  contains
    !> Stores the quantities of a state.
    procedure :: note
    !> First interface with a loss of area or energy; 0: none.
    procedure :: first_loss
    !> True: the strain energy has risen.
    procedure :: raises_strain
    !> Lines for the log: quantities of damage, and strain energy.
    procedure :: line
    procedure :: energy_line
    !> Adds them to the summary.
    procedure :: put
    !> Saves or loads.
    procedure :: visit
  end type mapped_figures_t

contains

  !> Stores the quantities of a state. Collective.
  subroutine note(self, model, state, moment)
    !> The quantities
    class(mapped_figures_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(inout) :: state
    !> before_mapping or after_mapping
    integer, intent(in) :: moment

    if (.not. allocated(self%plies)) then
      allocate (self%area(size(model%mesh%zones), 2), self%energy(size(model%mesh%zones), 2), self%plies(3, 2), &
                source=0.0_wp)
    end if
    self%strain(moment) = state%ledger%strain
    self%area(:, moment) = state%interfaces%cohesive%area(model)
    self%energy(:, moment) = state%interfaces%cohesive%energy(model)
    if (moment == before_mapping) self%dissipated = sum(self%energy(:, moment))
    if (.not. allocated(state%plies%bands)) return
    self%plies(:2, moment) = damage_of_plies(model, state)
    call state%plies%total_dissipation(model)
    self%plies(3, moment) = sum(state%plies%dissipated) + state%plies%permanent_shear
    if (moment == before_mapping) self%dissipated = self%dissipated + self%plies(3, moment)
  end subroutine note

  !> Areas of all plies times the damage of fibres and of the matrix, of the full plate. Collective.
  function damage_of_plies(model, state) result(areas)
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: state
    !> Of fibres and of the matrix
    real(wp) :: areas(2)
    type(exact_sum_t) :: fibres, matrix
    real(wp) :: damage(2), area
    integer :: i, ply

    do i = 1, model%elements%elements
      associate (mesh => model%mesh, element => model%distribution%elements(i))
        area = mesh%cell_area(mesh%place_of(mesh%element_cell(element)))
        do ply = mesh%element_plies(1, element), mesh%element_plies(2, element)
          damage = state%plies%bands%states%accepted_damage(ply, i)
          call fibres%add(area*damage(1))
          call matrix%add(area*damage(2))
        end do
      end associate
    end do
    areas = totals_of(model%communicator, [fibres, matrix])*model%mesh%multiplicity
  end function damage_of_plies

  !> First interface with a loss of area or energy, as its zone is too small; 0: none.
  pure integer function first_loss(self)
    !> The quantities
    class(mapped_figures_t), intent(in) :: self

    first_loss = findloc(self%area(:, 2) < (1 - tolerance)*self%area(:, 1) .or. &
                    self%energy(:, 2) < (1 - tolerance)*self%energy(:, 1), .true., dim=1)
  end function first_loss

  !> True if the strain energy has risen by more than 1 % of what was stored: mapped damage and displacements do not fit
  !> to each other, and stresses may cause further damage.
  pure logical function raises_strain(self)
    !> The quantities
    class(mapped_figures_t), intent(in) :: self

    associate (rise => self%strain(2) - self%strain(1))
      raises_strain = rise > max_rise*self%strain(1) .and. rise > fine*(self%strain(1) + self%dissipated)
    end associate
  end function raises_strain

  !> The strain energy, and what becomes of it.
  pure function energy_line(self, holds) result(line)
    !> The quantities
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
    !> The quantities
    class(mapped_figures_t), intent(in) :: self
    !> Ply above each interface
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

  !> Both values.
  pure function both(values) result(text)
    !> Before and after
    real(wp), intent(in) :: values(2)
    !> The text
    character(len=:), allocatable :: text

    text = rounded_text(values(1))//' -> '//rounded_text(values(2))
  end function both

  !> Adds them to the summary.
  subroutine put(self, json, below_plies)
    !> The quantities
    class(mapped_figures_t), intent(in) :: self
    !> The summary
    type(json_t), intent(inout) :: json
    !> Ply above each interface
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
    call put_both('energy_strain', self%strain)
    call json%close()

  contains

    !> Adds both values.
    subroutine put_both(name, values)
      !> Their name
      character(len=*), intent(in) :: name
      !> Before and after
      real(wp), intent(in) :: values(2)

      call json%put(name//'_before', values(1))
      call json%put(name//'_after', values(2))
    end subroutine put_both
  end subroutine put

  !> Saves or loads the quantities.
  subroutine visit(self, archive)
    !> The quantities
    class(mapped_figures_t), intent(inout) :: self
    !> Archive of the checkpoint
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
