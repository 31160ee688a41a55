!> A build for tests of files with provenance.
module sample_builds
  use run_provenance, only: build_t
  implicit none
  private
  public :: sample_build

contains

  !> An example of the data of a build.
  function sample_build() result(build)
    !> Version, commit, compiler and PETSc
    type(build_t) :: build

    build%version = '0.1.0'
    build%commit = '0123456789ab'
    build%compiler = 'GNU 12.2.0'
    build%petsc_version = '3.18.5'
  end function sample_build
end module sample_builds
