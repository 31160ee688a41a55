!> Last step on the equilibrium path of a static analysis, from which the next step under control of load or dissipation
!> starts.
module load_paths
  use field_mappings, only: motion_field
  use kinds, only: wp
  use archives, only: archive_t
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: load_path_t

  !> Last step of a path.
  type :: load_path_t
    !> True: the next step is controlled by the dissipated energy
    logical :: by_dissipation = .false.
    !> Change of the load factor in the last step, and its dissipated energy
    real(wp) :: factor_change = 0, dissipated = 0
    !> Change of the impactor's force in the last step
    real(wp) :: force_change = 0
    !> Change of the unknowns in the last step, (5, points); unallocated: load control throughout
    real(wp), allocatable :: change(:, :)
  contains
    procedure :: visit
  end type load_path_t

contains

  !> Saves or loads.
  subroutine visit(self, archive, plate)
    class(load_path_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate

    call archive%item('path/by_dissipation', self%by_dissipation)
    call archive%item('path/factor_change', self%factor_change)
    call archive%item('path/dissipated', self%dissipated)
    call archive%item('path/force_change', self%force_change)
    if (.not. allocated(self%change)) return
    call plate%visit_points(archive, 'path/change', self%change, motion_field)
    if (archive%loading) call plate%halo%update(self%change)
  end subroutine visit
end module load_paths
