!> A load case: initial state, supports, loads and impactor, and the kind of analysis with its load steps.
module load_cases
  use impact_parameters, only: impactor_parameters_t
  use initial_state_parameters, only: initial_state_t
  use kinds, only: wp
  use line_loads, only: line_load_t
  use loading_parameters, only: loading_t
  use pressure_loads, only: pressure_t
  use smooth_starts, only: smooth_ramp, smooth_step
  use support_parameters, only: support_t
  implicit none
  private
  public :: load_case_t

  !> A uniform change of temperature.
  type :: thermal_t
    !> True: residual stresses of the change are modelled
    logical :: is_present = .false.
    !> Temperature minus the stress-free temperature of the laminate
    real(wp) :: temperature_change = 0
  end type thermal_t

  !> A load case.
  type :: load_case_t
    !> Rigs under the plate; unallocated: none
    type(support_t), allocatable :: supports(:)
    type(impactor_parameters_t) :: impactor
    type(pressure_t) :: pressure
    !> Change of temperature
    type(thermal_t) :: thermal
    !> Lines across the plate; unallocated: none
    type(line_load_t), allocatable :: lines(:)
    !> Growth of the loads
    type(loading_t) :: loading
    type(initial_state_t) :: initial
  contains
    procedure :: is_static
    procedure :: has_inertia
    !> True: an impactor moves freely, or is pressed into the plate in load steps.
    procedure :: moves_impactor
    procedure :: presses_impactor
    procedure :: is_impact
    procedure :: progress_name
    procedure :: pressure_factor
    procedure :: load_level
    procedure :: load_factor_at
    procedure :: offset_left
  end type load_case_t

contains

  !> True: load steps.
  elemental logical function is_static(self)
    class(load_case_t), intent(in) :: self

    is_static = self%loading%by_steps
  end function is_static

  !> True: inertia forces act. Without them rigid-body motions must be constrained, and a softening plate has an
  !> indefinite tangent.
  elemental logical function has_inertia(self)
    class(load_case_t), intent(in) :: self

    has_inertia = .not. self%loading%by_steps
  end function has_inertia

  !> True: an impactor moves freely or with a prescribed travel in time.
  elemental logical function moves_impactor(self)
    class(load_case_t), intent(in) :: self

    moves_impactor = self%impactor%is_present .and. self%has_inertia()
  end function moves_impactor

  !> True: an impactor is pressed into the plate in load steps.
  elemental logical function presses_impactor(self)
    class(load_case_t), intent(in) :: self

    presses_impactor = self%impactor%is_present .and. self%is_static()
  end function presses_impactor

  !> True: an impactor of known mass and contact stiffness has an initial velocity.
  elemental logical function is_impact(self)
    class(load_case_t), intent(in) :: self

    is_impact = self%moves_impactor() .and. self%impactor%mass > 0 .and. self%impactor%velocity > 0 .and. &
                self%impactor%indentation%k > 0
  end function is_impact

  !> Name of the quantity that increases from step to step.
  pure function progress_name(self) result(name)
    class(load_case_t), intent(in) :: self
    character(len=:), allocatable :: name

    name = 'time'
    if (self%is_static()) name = 'load factor'
  end function progress_name

  !> Pressure over its full value.
  elemental real(wp) function pressure_factor(self, time, load_factor)
    class(load_case_t), intent(in) :: self
    !> Time of a motion, factor of all loads in load steps
    real(wp), intent(in) :: time, load_factor

    if (self%is_static()) then
      pressure_factor = load_factor
    else
      pressure_factor = self%pressure%amplitude(time)
    end if
  end function pressure_factor

  !> Loads relative to those at the end, the largest of a travel, pressure and lines; 1 in time with a free impactor,
  !> residual stresses or an initial state.
  elemental real(wp) function load_level(self, time)
    class(load_case_t), intent(in) :: self
    real(wp), intent(in) :: time
    real(wp) :: level
    integer :: i

    load_level = 1
    if (self%is_static()) load_level = time
    if (self%is_static() .or. self%thermal%is_present .or. self%initial%is_inherited) return
    if (self%impactor%is_present .and. .not. self%impactor%travel > 0) return
    level = -1
    if (self%impactor%is_present) &
      level = smooth_ramp(time/self%loading%ramp_time, self%impactor%rise/self%loading%ramp_time, 0)
    if (self%pressure%is_present) level = max(level, self%pressure%amplitude(time))
    if (allocated(self%lines)) then
      do i = 1, size(self%lines)
        if (abs(self%lines(i)%value) > 0) &
          level = max(level, self%lines(i)%at_factor(self%load_factor_at(time))/self%lines(i)%value)
      end do
    end if
    if (level >= 0) load_level = level
  end function load_level

  !> Ramps of lines over their full values at a time of a run by central differences.
  pure real(wp) function load_factor_at(self, time) result(load_factor)
    class(load_case_t), intent(in) :: self
    real(wp), intent(in) :: time

    load_factor = max(0.0_wp, time - self%loading%start)/self%loading%ramp_time
  end function load_factor_at

  !> Factor at a time of the offsets between initial and prescribed displacements of supports and lines: it decreases
  !> smoothly to zero until the loads start, and is constant without time for that.
  pure real(wp) function offset_left(self, time) result(left)
    class(load_case_t), intent(in) :: self
    real(wp), intent(in) :: time

    left = 1
    if (self%loading%start > 0) left = 1 - smooth_step(time/self%loading%start, 0)
  end function offset_left
end module load_cases
