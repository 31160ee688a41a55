!> Provenance of a result, stored in every output, so that it can be traced and repeated.
module run_provenance
  use logger, only: log_t
  use text, only: counted, to_text
  implicit none
  private
  public :: build_t, provenance_t, this_run, citation_of

  !> Versions of the program.
  type :: build_t
    !> Version of Implam
    character(len=:), allocatable :: version
    !> Commit of its source
    character(len=:), allocatable :: commit
    !> Compiler it was built with
    character(len=:), allocatable :: compiler
    !> Version of PETSc it was built with
    character(len=:), allocatable :: petsc_version
  end type build_t

  !> Provenance of a run.
  type, extends(build_t) :: provenance_t
    !> Text of the deck
    character(len=:), allocatable :: deck
    !> Name of the case, by default that of the deck's file; empty: not given
    character(len=:), allocatable :: case_name
    !> Units of the deck; empty: any consistent ones
    character(len=:), allocatable :: units
    !> Values in effect from the table of published materials; empty: none
    character(len=:), allocatable :: library
    !> Date and time the run started, local time with its distance from UTC, ISO 8601
    character(len=:), allocatable :: started
    !> Number of ranks
    integer :: ranks = 0
  contains
    procedure :: report
  end type provenance_t

contains

  !> How to cite the program, as in CITATION.cff.
  pure function citation_of(version) result(citation)
    !> Version of Implam
    character(len=*), intent(in) :: version
    !> The program with the year of its release, and the paper whose method it extends, as in CITATION.cff
    character(len=:), allocatable :: citation

    citation = 'The Implam developers: Implam '//version//' (2026), low-velocity impact on composite laminates. '// &
               'Method: C. F. Li, N. Hu, Y. J. Yin, H. Sekine, H. Fukunaga, Composites Part A 33 (2002) 1055-1062.'
  end function citation_of

  !> Provenance of the run that is starting.
  function this_run(build, deck, ranks) result(run)
    !> Versions of this program
    type(build_t), intent(in) :: build
    character(len=*), intent(in) :: deck
    integer, intent(in) :: ranks
    type(provenance_t) :: run
    character(len=8) :: date
    character(len=10) :: time
    character(len=5) :: zone

    call date_and_time(date, time, zone)
    run%deck = deck
    run%case_name = ''
    run%units = ''
    run%library = ''
    run%build_t = build
    run%started = date(1:4)//'-'//date(5:6)//'-'//date(7:8)//'T'//time(1:2)//':'//time(3:4)//':'//time(5:6) &
      //zone(1:3)//':'//zone(4:5)
    run%ranks = ranks
  end function this_run

  !> Writes the provenance to the log; the deck is written to the log file only.
  subroutine report(self, log)
    class(provenance_t), intent(in) :: self
    type(log_t), intent(inout) :: log

    call log%note('Implam '//self%version//' (commit '//self%commit//'), '//self%compiler//', PETSc ' &
                  //self%petsc_version//', '//counted(to_text(self%ranks), 'rank') &
                  //', started '//self%started)
    call log%detail('To cite: '//citation_of(self%version))
    call log%detail('deck:'//new_line('a')//self%deck)
    call log%detail('end of the deck')
  end subroutine report
end module run_provenance
