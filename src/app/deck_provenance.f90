!> Provenance of the results: program, deck, and values in effect.
module deck_provenance
  use build_information, only: this_build
  use deck_contents, only: deck_t
  use deck_echo, only: adopted_values
  use run_provenance, only: provenance_t, this_run
  implicit none
  private
  public :: provenance_of

contains

  !> Provenance of the run of a deck that is starting.
  function provenance_of(deck, ranks) result(run)
    type(deck_t), intent(in) :: deck
    !> Number of ranks
    integer, intent(in) :: ranks
    type(provenance_t) :: run

    run = this_run(this_build(), deck%text, ranks)
    run%units = deck%case%units
    run%case_name = deck%case%name
    run%library = adopted_values(deck%settings)
  end function provenance_of
end module deck_provenance
