!> Progress of the run: a bar on a terminal, lines at intervals elsewhere, with the remaining time.
module run_progress
  use kinds, only: long, wp
  use logger, only: log_t
  use run_paces, only: run_pace_t
  use text, only: to_text
  implicit none
  private
  public :: progress_t

  !> Seconds between two updates of the bar, short for a reader. These three values have no effect on results.
  real(wp), parameter :: between_bars = 0.2_wp
  !> Seconds between two lines, unless the next fraction is completed earlier.
  real(wp), parameter :: between_lines = 10
  !> Fraction of the run between two lines, if completed earlier.
  real(wp), parameter :: part_between_lines = 0.1_wp
  !> Characters of the bar.
  integer, parameter :: bar_length = 30

  !> Progress of one run.
  type :: progress_t
    private
    !> Its speed
    type(run_pace_t) :: pace
    !> Completed fraction at the last output
    real(wp) :: shown = 0
    !> Clock at the start of this process
    integer(long) :: started = 0
    !> Clock at the last output
    integer(long) :: shown_at = 0
  contains
    procedure :: start
    procedure :: is_due
    procedure :: update
    procedure :: finish
  end type progress_t

contains

  !> Starts the clock.
  subroutine start(self, fraction, done)
    class(progress_t), intent(inout) :: self
    !> Completed fraction of the run: 0, or more after a restart
    real(wp), intent(in) :: fraction
    !> The same in the unit of the run: steps, or time
    real(wp), intent(in) :: done
    integer(long) :: rate

    self%shown = fraction
    call system_clock(self%started, rate)
    self%shown_at = self%started
    call self%pace%start(0.0_wp, done)
  end subroutine start

  !> True: progress is due for output.
  logical function is_due(self, log, fraction)
    class(progress_t), intent(in) :: self
    type(log_t), intent(in) :: log
    !> Completed fraction of the run
    real(wp), intent(in) :: fraction
    integer(long) :: now, rate
    real(wp) :: since

    call system_clock(now, rate)
    since = real(now - self%shown_at, wp)/rate
    if (log%interactive) then
      is_due = .not. since < between_bars
    else
      is_due = .not. (since < between_lines .and. fraction < self%shown + part_between_lines)
    end if
  end function is_due

  !> Prints the progress.
  subroutine update(self, log, fraction, done, left, text)
    class(progress_t), intent(inout) :: self
    type(log_t), intent(inout) :: log
    !> Completed fraction of the run
    real(wp), intent(in) :: fraction
    !> Completed and remaining part, in one unit: steps, or time
    real(wp), intent(in) :: done, left
    !> Further information, such as the time in the setup
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: line
    integer(long) :: now, rate
    real(wp) :: elapsed, remaining

    call system_clock(now, rate)
    elapsed = real(now - self%started, wp)/rate
    remaining = self%pace%left(elapsed, done, left)
    line = to_text(int(100*fraction))//' %, ? left'
    if (remaining >= 0) line = to_text(int(100*fraction))//' %, '//duration(remaining)//' left'
    call self%pace%note(elapsed, done)
    if (len(text) > 0) line = line//', '//text
    if (log%interactive) then
      call log%status(bar(fraction)//' '//line)
    else
      call log%note(line)
    end if
    self%shown = fraction
    self%shown_at = now
  end subroutine update

  !> Reports the end of the run and the time of this process.
  subroutine finish(self, log, text)
    class(progress_t), intent(in) :: self
    type(log_t), intent(inout) :: log
    !> How the run ended
    character(len=*), intent(in) :: text
    integer(long) :: now, rate

    call system_clock(now, rate)
    call log%note(text//' after '//duration(real(now - self%started, wp)/rate)//'.')
  end subroutine finish

  !> A time in a suitable unit.
  pure function duration(seconds) result(words)
    !> The time in seconds
    real(wp), intent(in) :: seconds
    !> Such as 4.2 s, 12 min 5 s or 3 h 20 min
    character(len=:), allocatable :: words
    character(len=12) :: digits
    integer :: whole

    whole = nint(min(max(seconds, 0.0_wp), 1.0e9_wp))
    if (seconds < 59.5_wp) then
      write (digits, '(f12.1)') max(seconds, 0.0_wp)
      words = trim(adjustl(digits))//' s'
    else if (whole < 3600) then
      words = to_text(whole/60)//' min '//to_text(mod(whole, 60))//' s'
    else
      words = to_text(whole/3600)//' h '//to_text(mod(whole, 3600)/60)//' min'
    end if
  end function duration

  !> A bar such as [######......].
  pure function bar(fraction)
    !> Part to fill
    real(wp), intent(in) :: fraction
    character(len=bar_length + 2) :: bar
    integer :: filled

    filled = min(max(int(bar_length*fraction), 0), bar_length)
    bar = '['//repeat('#', filled)//repeat('.', bar_length - filled)//']'
  end function bar
end module run_progress
