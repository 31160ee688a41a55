!> Corrections of an iteration with cohesive points in equilibrium: the factored operator's answer, mended at the points
!> whose tractions it does not know, on its answers to unit forces there.
module condensed_corrections
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t
  use condensed_points, only: condensed_points_t
  use face_friction, only: sliding_t
  use kinds, only: wp
  use models, only: model_t
  use outside_forces, only: outside_force_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: condensed_correction_t, new_condensed_correction

  !> Force left at a point over that at its strength from which it becomes an unknown. With it
  !> crossply_cohesive_2mm.nml takes one iteration a step; ten times or a tenth of it dissipates the same area to 4e-9.
  real(wp), parameter :: noticed = 1.0e-4_wp
  !> Unknowns at most, and those that join together at most.
  integer, parameter :: most_unknowns = 500, most_joining = 300
  !> Numbers in the operator's answers to forces on them at most, and to those that join together: with all that
  !> `most_joining` allows cohesive_threshold.nml with cells of .5 mm and 81 000 unknowns takes 1.3 times as long. Not
  !> where plies break in rounds, which forget what a crowd has found: there the 25 J panel took 1.4 times as long.
  real(wp), parameter :: most_numbers = 1.0e8_wp, most_joining_numbers = 8.0e6_wp
  !> Unknowns of failed points that join together at most. Their faces open or close, and do so again in the next step,
  !> while answers to the forces of a front serve many steps. It decides on cost alone: with 50 the free flight of
  !> peanut.nml takes .84 of the time that it takes with 300, and has the same energies to nine digits.
  integer, parameter :: most_clapping = 50
  !> Numbers that tell of an unknown.
  integer, parameter :: told = 18

  !> A correction in the making.
  type :: condensed_correction_t
    !> The small system; its unknowns are the operator's columns, and the patch's mean deflection with an impactor
    type(condensed_points_t) :: system
    !> Change of the unknowns at equilibrium; that of the columns first
    real(wp), allocatable :: change(:)
    !> Columns among them
    integer :: columns = 0
  contains
    !> Finds the equilibrium.
    procedure :: solve
    !> The field of the correction.
    procedure :: field
    !> Equations of points that should be unknowns and are none.
    procedure :: wanting
  end type condensed_correction_t

contains

  !> A correction with the columns that the operator has.
  subroutine new_condensed_correction(operator, model, old, displacement, correction, guess, self)
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> Cohesive interfaces in the last accepted state
    type(cohesive_interfaces_t), intent(in) :: old
    !> Displacement before the correction, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> The operator's answer, (5, points)
    real(wp), intent(in) :: correction(:, :)
    !> What is known of the change of the first unknowns, (at most the columns)
    real(wp), intent(in) :: guess(:)
    !> The correction
    type(condensed_correction_t), intent(out) :: self
    real(wp), allocatable :: response(:)
    real(wp) :: compliance

    self%columns = operator%changes%kept
    if (self%columns == 0) return
    self%system%free = operator%changes%values(model%communicator, operator%numbering, correction)
    response = operator%changes%values(model%communicator, operator%numbering, operator%response)
    ! Mean deflections over the number of parts of the plate are what the force on the modelled part does work on.
    compliance = operator%compliance/model%mesh%multiplicity
    call operator%changes%stiffness_of_columns(response, compliance, self%system%stiffness)
    call gather_points(operator, model, old, displacement, correction, self%system)
    if (model%scene%has_impactor) then
      self%system%free = [self%system%free, model%patch_mean(correction)/model%mesh%multiplicity]
      self%system%held = [self%system%held, 0.0_wp]
    end if
    self%change = 0*self%system%free
    self%change(:size(guess)) = guess
    self%system%forces = self%change
  end subroutine new_condensed_correction

  !> Gathers the points of all unknowns on every rank.
  subroutine gather_points(operator, model, old, displacement, correction, system)
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    type(model_t), intent(in) :: model
    !> Cohesive interfaces in the last accepted state
    type(cohesive_interfaces_t), intent(in) :: old
    !> Displacement before the correction, and the operator's answer, (5, points)
    real(wp), intent(in) :: displacement(:, :), correction(:, :)
    !> The system
    type(condensed_points_t), intent(inout) :: system
    real(wp) :: tale(told, operator%changes%kept), changed(3, size(model%zone)), all(size(tale))
    integer :: k, i, component, shared

    call operator%changes%spread_out(operator%numbering, changed)
    tale = 0
    do k = 1, operator%changes%kept
      if (.not. operator%numbering%owns(operator%changes%columns(k)%equation)) cycle
      call operator%numbering%place_of(operator%changes%columns(k)%equation, i, component)
      tale(1:3, k) = real([model%distribution%points(i), model%zone(i), component], wp)
      shared = operator%numbering%sharers(i)
      tale(4, k) = -shared*changed(component, i)
      if (.not. old%cohesive(i)) cycle
      tale(4, k) = shared*operator%present(component, i)
      tale(5:7, k) = displacement(1:3, i)
      tale(8:10, k) = correction(1:3, i)
      tale(11, k) = shared*model%contact_area(i)*operator%stiffness_factor
      tale(12:13, k) = [old%points(i)%damage, old%points(i)%dissipated]
      tale(14, k) = 1
      tale(15:17, k) = [old%points(i)%sliding%slip, old%points(i)%sliding%limit]
      tale(18, k) = old%strength(i)
    end do
    all = reshape(tale, [size(tale)])
    call model%communicator%sum(all)
    tale = reshape(all, shape(tale))
    system%held = tale(4, :)
    call group_points(model, old, tale, system)
  end subroutine gather_points

  !> Puts the unknowns of each point together.
  subroutine group_points(model, old, tale, system)
    type(model_t), intent(in) :: model
    !> Cohesive interfaces in the last accepted state
    type(cohesive_interfaces_t), intent(in) :: old
    !> What is told of each unknown, (told, unknowns)
    real(wp), intent(in) :: tale(:, :)
    !> The system
    type(condensed_points_t), intent(inout) :: system
    type(cohesive_point_t) :: new
    integer :: point_of(size(tale, 2)), k, first, points

    points = 0
    do k = 1, size(tale, 2)
      point_of(k) = 0
      if (.not. tale(14, k) > 0) cycle
      do first = 1, k - 1
        if (nint(tale(1, first)) == nint(tale(1, k)) .and. tale(14, first) > 0) exit
      end do
      if (first == k) points = points + 1
      point_of(k) = merge(points, point_of(min(first, k)), first == k)
    end do
    allocate (system%points(points))
    do k = 1, size(tale, 2)
      if (point_of(k) == 0) cycle
      associate (point => system%points(point_of(k)))
        point%faces = old%faces_of(model, nint(tale(2, k)), tale(18, k))
        point%area = tale(11, k)
        point%old = cohesive_point_t(damage=tale(12, k), dissipated=tale(13, k))
        point%old%sliding = sliding_t(slip=tale(15:16, k), limit=tale(17, k))
        point%jumps = tale(5:7, k)
        point%drift = tale(8:10, k)
        point%unknown(nint(tale(3, k))) = k
        call point%faces%traction(point%jumps, point%old, point%traction, new)
      end associate
    end do
  end subroutine group_points

  !> Finds the equilibrium.
  subroutine solve(self, outside)
    !> The correction
    class(condensed_correction_t), intent(inout) :: self
    !> Force of the impactor; unallocated: there is none
    class(outside_force_t), allocatable, intent(inout) :: outside

    call self%system%solve(outside, self%change)
  end subroutine solve

  !> Completes a correction: the operator's answer, mended by the forces of the unknowns.
  subroutine field(self, operator, correction)
    !> The correction, solved
    class(condensed_correction_t), intent(in) :: self
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    !> The operator's answer on entry, the correction on return, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    integer :: k

    associate (forces => self%system%forces)
      call operator%changes%combine([(k, k=1, self%columns)], forces(:self%columns), correction)
      if (size(forces) > self%columns) correction = correction - forces(size(forces))*operator%response
    end associate
  end subroutine field

  !> Equations of points that should be unknowns and are none: the operator's answer is wrong there.
  subroutine wanting(self, operator, model, old, displacement, correction, equations, crowded)
    !> The correction
    class(condensed_correction_t), intent(in) :: self
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    type(model_t), intent(in) :: model
    !> Cohesive interfaces in the last accepted state
    type(cohesive_interfaces_t), intent(in) :: old
    !> Displacement before the correction, and the correction, (5, points)
    real(wp), intent(in) :: displacement(:, :), correction(:, :)
    !> The equations, the same on every rank
    integer, allocatable, intent(out) :: equations(:)
    !> True: there is no room for all of them
    logical, intent(out) :: crowded
    real(wp) :: error(3, model%distribution%owned), clapping(1)
    integer :: i, most

    call old%mismatch(model, operator%stiffness_factor, operator%present, displacement, correction, error)
    call strike_columns(operator, error)
    where (operator%numbering%equation(1:3, :size(error, 2)) < 0) error = 0
    ! Points that follow others have the equations of these.
    do i = 1, size(error, 2)
      if (operator%numbering%leader(i) > 0) error(:, i) = 0
    end do
    call model%communicator%allgather(pack(operator%numbering%equation(1:3, :size(error, 2)), error > noticed), &
                                      equations)
    clapping = sum([(count(error(:, i) > noticed), i=1, size(error, 2))], &
                   mask=old%points(:size(error, 2))%damage >= 1)
    call model%communicator%sum(clapping)
    associate (total => operator%numbering%total)
      most = min(most_joining, min(most_unknowns, int(most_numbers/total)) - self%columns)
      if (.not. model%scene%has_crack_bands()) most = min(most, int(most_joining_numbers/total))
    end associate
    crowded = clapping(1) > most_clapping .or. size(equations) > most
  end subroutine wanting

  !> Leaves out what is an unknown already.
  pure subroutine strike_columns(operator, error)
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    !> Force left over that at the strength, (3, owned points)
    real(wp), intent(inout) :: error(:, :)
    integer :: k, i, component

    do k = 1, operator%changes%kept
      if (.not. operator%numbering%owns(operator%changes%columns(k)%equation)) cycle
      call operator%numbering%place_of(operator%changes%columns(k)%equation, i, component)
      error(component, i) = 0
    end do
  end subroutine strike_columns
end module condensed_corrections
