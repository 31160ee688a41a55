!> Provenance inside an HDF5 file: a group with a text or number a component.
module stored_provenance
  use hdf5_data, only: read_integers, read_text, write_integers, write_text
  use hdf5_file, only: hdf5_file_t
  use run_provenance, only: citation_of, provenance_t
  implicit none
  private
  public :: write_provenance, read_provenance

contains

  !> Writes a provenance.
  subroutine write_provenance(file, group, run)
    type(hdf5_file_t), intent(inout) :: file
    !> Path of the group
    character(len=*), intent(in) :: group
    !> The run
    type(provenance_t), intent(in) :: run

    call write_text(file, group//'/deck', run%deck)
    call write_text(file, group//'/case_name', run%case_name)
    if (allocated(run%units)) then
      if (run%units /= '') call write_text(file, group//'/units', run%units)
    end if
    if (allocated(run%library)) then
      if (run%library /= '') call write_text(file, group//'/library', run%library)
    end if
    call write_text(file, group//'/version', run%version)
    call write_text(file, group//'/commit', run%commit)
    call write_text(file, group//'/compiler', run%compiler)
    call write_text(file, group//'/petsc_version', run%petsc_version)
    call write_text(file, group//'/started', run%started)
    call write_text(file, group//'/citation', citation_of(run%version))
    call write_integers(file, group//'/ranks', [run%ranks], [integer ::])
  end subroutine write_provenance

  !> Reads a provenance.
  subroutine read_provenance(file, group, run)
    type(hdf5_file_t), intent(inout) :: file
    !> Path of the group
    character(len=*), intent(in) :: group
    !> The run
    type(provenance_t), intent(out) :: run
    integer, allocatable :: ranks(:)

    call read_text(file, group//'/deck', run%deck)
    call read_text(file, group//'/case_name', run%case_name)
    run%library = ''
    if (file%exists(group//'/library')) call read_text(file, group//'/library', run%library)
    call read_text(file, group//'/version', run%version)
    call read_text(file, group//'/commit', run%commit)
    call read_text(file, group//'/compiler', run%compiler)
    call read_text(file, group//'/petsc_version', run%petsc_version)
    call read_text(file, group//'/started', run%started)
    call read_integers(file, group//'/ranks', ranks, [integer ::])
    run%ranks = ranks(1)
  end subroutine read_provenance
end module stored_provenance
