!> Provenance in the summary.
module summary_provenance
  use json_text, only: json_t
  use run_provenance, only: citation_of, provenance_t
  implicit none
  private
  public :: put_provenance

contains

  !> Provenance of the result.
  subroutine put_provenance(json, provenance)
    type(json_t), intent(inout) :: json
    type(provenance_t), intent(in) :: provenance

    call json%open_object('provenance')
    call json%put('version', provenance%version)
    call json%put('commit', provenance%commit)
    call json%put('compiler', provenance%compiler)
    call json%put('petsc_version', provenance%petsc_version)
    call json%put('citation', citation_of(provenance%version))
    call json%put('ranks', provenance%ranks)
    call json%put('started', provenance%started)
    call json%put('deck', provenance%deck)
    if (provenance%library /= '') call json%put('library', provenance%library)
    call json%close()
  end subroutine put_provenance
end module summary_provenance
