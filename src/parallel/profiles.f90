!> Profile of time and memory of a run by parts. Time and memory of a part exclude those of the parts inside it, so that
!> the sum over all parts is that of the run.
module profiles
  use, intrinsic :: iso_c_binding, only: c_int, c_long
  use kinds, only: wp, long
  implicit none
  private
  public :: profile_t, profile_row_t, new_profile, wall_time

  !> Longest name of a part.
  integer, parameter, public :: part_length = 32
  !> Largest depth of parts inside each other.
  integer, parameter :: max_depth = 32

  !> One part of a run.
  type :: profile_row_t
    !> Name of the part
    character(len=part_length) :: name = ''
    !> Wall-clock seconds
    real(wp) :: seconds = 0
    !> Number of calls
    integer :: calls = 0
    !> Increase of the run's largest resident memory by the part, in MB of 10^6 bytes
    real(wp) :: megabytes = 0
  end type profile_row_t

  !> The profile so far.
  type :: record_t
    !> The parts in the order of their first beginning
    type(profile_row_t), allocatable :: rows(:)
    !> Parts begun and not ended, the innermost last
    integer :: open(max_depth) = 0, depth = 0
    !> Clock and peak memory at the last update of the innermost part
    real(wp) :: seconds = 0, megabytes = 0
  end type record_t

  !> A profile, or none. Copies share their data, so that every part of the program can have one.
  type :: profile_t
    !> Clock at the program's start
    real(wp) :: begun = 0
    !> The data; null: no profile
    type(record_t), pointer, private :: record => null()
  contains
    procedure :: enter
    procedure :: leave
    procedure :: rows
    procedure :: release
  end type profile_t

  interface
    !> C library: resources used by a process.
    integer(c_int) function get_usage(who, usage) bind(c, name='getrusage')
      import :: c_int, c_long
      !> 0: this process
      integer(c_int), value :: who
      !> Two times of two numbers, then fourteen numbers, the first the largest resident memory in KiB
      integer(c_long), intent(out) :: usage(18)
    end function get_usage
  end interface

contains

  !> Starts a profile. Processor time before it, for loading libraries, is its first part.
  function new_profile(requested) result(self)
    !> False: only the clock is read
    logical, intent(in) :: requested
    type(profile_t) :: self

    self%begun = wall_time()
    if (.not. requested) return
    allocate (self%record)
    associate (record => self%record)
      record%rows = [profile_row_t('program and libraries', calls=1), profile_row_t('rest', calls=1)]
      call cpu_time(record%rows(1)%seconds)
      record%rows(1)%megabytes = peak_megabytes()
      record%depth = 1
      record%open(1) = 2
      record%seconds = self%begun
      record%megabytes = record%rows(1)%megabytes
    end associate
  end function new_profile

  !> Begins a part.
  subroutine enter(self, name)
    class(profile_t), intent(in) :: self
    !> Name of the part
    character(len=*), intent(in) :: name
    integer :: i

    if (.not. associated(self%record)) return
    associate (record => self%record)
      call add_elapsed(record)
      do i = size(record%rows), 1, -1
        if (record%rows(i)%name == name) exit
      end do
      if (i == 0) then
        record%rows = [record%rows, profile_row_t(name)]
        i = size(record%rows)
      end if
      record%rows(i)%calls = record%rows(i)%calls + 1
      record%depth = min(record%depth + 1, max_depth)
      record%open(record%depth) = i
    end associate
  end subroutine enter

  !> Ends the part begun last.
  subroutine leave(self)
    class(profile_t), intent(in) :: self

    if (.not. associated(self%record)) return
    call add_elapsed(self%record)
    self%record%depth = max(1, self%record%depth - 1)
  end subroutine leave

  !> Adds time and memory since the last update to the innermost part. Memory is queried at intervals only, as the query
  !> takes longer than small parts.
  subroutine add_elapsed(record)
    !> The profile so far
    type(record_t), intent(inout) :: record
    real(wp) :: seconds, megabytes
    ! Seconds: twice the duration of the query, which reads a file of the system.
    real(wp), parameter :: min_query_interval = 1.0e-4_wp

    seconds = wall_time()
    megabytes = record%megabytes
    if (seconds - record%seconds > min_query_interval) megabytes = peak_megabytes()
    associate (row => record%rows(record%open(record%depth)))
      row%seconds = row%seconds + seconds - record%seconds
      row%megabytes = row%megabytes + megabytes - record%megabytes
    end associate
    record%seconds = seconds
    record%megabytes = megabytes
  end subroutine add_elapsed

  !> The parts so far.
  function rows(self)
    class(profile_t), intent(in) :: self
    !> The parts, empty without a profile
    type(profile_row_t), allocatable :: rows(:)

    allocate (rows(0))
    if (.not. associated(self%record)) return
    call add_elapsed(self%record)
    rows = self%record%rows
  end function rows

  !> Deallocates the shared data; no copy may be used afterwards.
  subroutine release(self)
    class(profile_t), intent(inout) :: self

    if (associated(self%record)) deallocate (self%record)
    self%record => null()
  end subroutine release

  !> Largest resident memory so far, in MB of 10^6 bytes; 0 where the system does not report it.
  real(wp) function peak_megabytes()
    integer(c_long) :: usage(18)

    peak_megabytes = 0
    if (get_usage(0_c_int, usage) == 0) peak_megabytes = usage(5)*1024.0e-6_wp
  end function peak_megabytes

  !> Wall-clock seconds since some moment in the past.
  real(wp) function wall_time()
    integer(long) :: ticks, rate

    call system_clock(ticks, rate)
    wall_time = real(ticks, wp)/real(rate, wp)
  end function wall_time
end module profiles
