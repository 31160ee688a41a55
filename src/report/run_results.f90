!> The results of a run: values of the rows of the table, filled once. Those that a run does not have are not in the
!> list; those not known, such as the rebound of an impactor still in contact, are null.
module run_results
  use json_text, only: json_t
  use kinds, only: wp
  use summary_rows, only: label_of_result, type_of_result, unit_of_result
  use usual_units, only: in_usual_unit, time_kind
  implicit none
  private
  public :: results_t, new_results

  !> A result.
  type :: result_t
    !> Name, in the table
    character(len=:), allocatable :: name
    !> Value; logicals are 1 and 0
    real(wp) :: value = 0
    !> False: null
    logical :: is_known = .true.
  end type result_t

  !> All of them.
  type :: results_t
    !> Those that the run has, in order
    type(result_t), allocatable, private :: list(:)
    !> System of units of the deck; empty: not known
    character(len=:), allocatable :: system
    !> True: times are load factors or fractions of the run
    logical, private :: by_load_steps = .false.
  contains
    !> Adds a result.
    generic :: add => add_real, add_integer, add_logical
    procedure :: value => value_of
    procedure :: has
    procedure :: shown
    procedure :: labelled
    procedure :: with_unit
    procedure :: put
    procedure, private :: add_real, add_integer, add_logical
  end type results_t

contains

  !> An empty list.
  pure function new_results(system, by_load_steps) result(self)
    !> System of units of the deck; empty: not known
    character(len=*), intent(in) :: system
    !> True: a run by load steps
    logical, intent(in) :: by_load_steps
    type(results_t) :: self

    allocate (self%list(0))
    self%system = system
    self%by_load_steps = by_load_steps
  end function new_results

  !> Adds a number.
  pure subroutine add_real(self, name, value, is_known)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> Its value
    real(wp), intent(in) :: value
    !> False: not known
    logical, intent(in), optional :: is_known
    type(result_t) :: one

    one%name = name
    one%value = value
    if (present(is_known)) one%is_known = is_known
    self%list = [self%list, one]
  end subroutine add_real

  !> Adds a whole number.
  pure subroutine add_integer(self, name, value)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> Its value
    integer, intent(in) :: value

    call self%add_real(name, real(value, wp))
  end subroutine add_integer

  !> Adds a logical.
  pure subroutine add_logical(self, name, value)
    class(results_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> Its value
    logical, intent(in) :: value

    call self%add_real(name, merge(1.0_wp, 0.0_wp, value))
  end subroutine add_logical

  !> Place of a result in the list; 0: it is not there.
  pure integer function place_of(self, name) result(place)
    class(results_t), intent(in) :: self
    character(len=*), intent(in) :: name

    do place = size(self%list), 1, -1
      if (self%list(place)%name == name) return
    end do
  end function place_of

  !> True: a result is there and known.
  pure logical function has(self, name)
    class(results_t), intent(in) :: self
    character(len=*), intent(in) :: name
    integer :: place

    place = place_of(self, name)
    has = place > 0
    if (has) has = self%list(place)%is_known
  end function has

  !> Value of a result; 0: not known or not there.
  pure real(wp) function value_of(self, name) result(value)
    class(results_t), intent(in) :: self
    character(len=*), intent(in) :: name

    value = 0
    if (self%has(name)) value = self%list(place_of(self, name))%value
  end function value_of

  !> Value of a result with its unit, rounded to four digits.
  pure function shown(self, name, digits) result(words)
    class(results_t), intent(in) :: self
    character(len=*), intent(in) :: name
    !> Significant digits, four if not given
    integer, intent(in), optional :: digits
    !> Such as 2.468 kN
    character(len=:), allocatable :: words

    words = self%with_unit(self%value(name), unit_of_result(name), digits)
  end function shown

  !> Label and value of a result.
  pure function labelled(self, name, round_off) result(words)
    class(results_t), intent(in) :: self
    character(len=*), intent(in) :: name
    !> Size up to which it is printed as 0; 0 if not given
    real(wp), intent(in), optional :: round_off
    !> Such as strain 1.2 J
    character(len=:), allocatable :: words

    words = label_of_result(name)//' '//self%shown(name)
    if (.not. present(round_off)) return
    if (abs(self%value(name)) <= round_off) words = label_of_result(name)//' 0'
  end function labelled

  !> A value of some kind with its unit; times of load steps have none.
  pure function with_unit(self, value, kind, digits) result(words)
    class(results_t), intent(in) :: self
    real(wp), intent(in) :: value
    !> Kind of unit
    character(len=*), intent(in) :: kind
    !> Significant digits, four if not given
    integer, intent(in), optional :: digits
    !> Such as 2.468 kN
    character(len=:), allocatable :: words
    character(len=:), allocatable :: dimension_now

    dimension_now = kind
    if (kind == time_kind .and. self%by_load_steps) dimension_now = '-'
    words = in_usual_unit(value, dimension_now, self%system, digits)
  end function with_unit

  !> Writes all as members of the summary.
  subroutine put(self, json)
    class(results_t), intent(in) :: self
    type(json_t), intent(inout) :: json
    integer :: i

    do i = 1, size(self%list)
      associate (one => self%list(i))
        if (.not. one%is_known) then
          call json%put_null(one%name)
          cycle
        end if
        select case (type_of_result(one%name))
        case ('integer')
          call json%put(one%name, nint(one%value))
        case ('logical')
          call json%put(one%name, one%value > 0)
        case default
          call json%put(one%name, one%value)
        end select
      end associate
    end do
  end subroutine put
end module run_results
