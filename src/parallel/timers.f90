!> Named timers of wall-clock and processor time.
module timers
  use kinds, only: wp
  use profiles, only: profile_t, wall_time
  implicit none
  private
  public :: timer_set_t, wall_time

  !> Longest name of a timer.
  integer, parameter :: name_length = 32

  !> One timer.
  type :: timer_t
    !> Name of the timed part
    character(len=name_length) :: name = ''
    !> Seconds of wall-clock and of processor time, summed over all finished intervals
    real(wp) :: wall = 0, processor = 0
    !> Times at the start of the present interval
    real(wp) :: wall_start = 0, processor_start = 0
    !> Number of finished intervals
    integer :: runs = 0
  end type timer_t

  !> A set of timers known by their names; a name is new the first time it is started.
  type :: timer_set_t
    !> The timers in the order of their first start
    type(timer_t), allocatable, private :: list(:)
    !> Profile to which the times are added, too
    type(profile_t) :: profile
  contains
    procedure :: start
    procedure :: stop => stop_timer
    procedure :: lines
    procedure, private :: position
  end type timer_set_t

contains

  !> Starts a timer.
  subroutine start(self, name, part)
    class(timer_set_t), intent(inout) :: self
    !> Name of the timed part
    character(len=*), intent(in) :: name
    !> Part of the profile that it belongs to, if that has another name
    character(len=*), intent(in), optional :: part
    integer :: i

    if (present(part)) then
      call self%profile%enter(part)
    else
      call self%profile%enter(name)
    end if
    if (.not. allocated(self%list)) allocate (self%list(0))
    i = self%position(name)
    if (i == 0) then
      self%list = [self%list, timer_t(name=name)]
      i = size(self%list)
    end if
    self%list(i)%wall_start = wall_time()
    call cpu_time(self%list(i)%processor_start)
  end subroutine start

  !> Stops a timer that was started and adds the interval.
  subroutine stop_timer(self, name)
    class(timer_set_t), intent(inout) :: self
    !> Name of the timed part
    character(len=*), intent(in) :: name
    real(wp) :: processor
    integer :: i

    call self%profile%leave()
    i = self%position(name)
    if (i == 0) return
    call cpu_time(processor)
    associate (timer => self%list(i))
      timer%wall = timer%wall + wall_time() - timer%wall_start
      timer%processor = timer%processor + processor - timer%processor_start
      timer%runs = timer%runs + 1
    end associate
  end subroutine stop_timer

  !> A table for the log, one line per timer.
  pure function lines(self)
    class(timer_set_t), intent(in) :: self
    !> Name, runs, wall-clock seconds, processor seconds
    character(len=name_length + 40), allocatable :: lines(:)
    integer :: i

    allocate (lines(0))
    if (.not. allocated(self%list)) return
    deallocate (lines)
    allocate (lines(size(self%list)))
    do i = 1, size(lines)
      associate (timer => self%list(i))
        write (lines(i), '(a,i10,f13.3," s",f13.3," s")') timer%name, timer%runs, timer%wall, timer%processor
      end associate
    end do
  end function lines

  !> Position of a timer in the list, 0 if there is none of that name.
  pure integer function position(self, name)
    class(timer_set_t), intent(in) :: self
    !> Name of the timed part
    character(len=*), intent(in) :: name

    position = 0
    if (.not. allocated(self%list)) return
    do position = size(self%list), 1, -1
      if (self%list(position)%name == name) return
    end do
  end function position
end module timers
