!> Matrix cracks of neighbouring plies as flaws of a cohesive interface: within a distance of a crack damage starts at
!> less than the strengths of the material, and takes the same toughness.
!>
!> A point whose damage has begun keeps its law, so that what it has dissipated keeps its meaning.
module interface_flaws
  use archives, only: archive_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use models, only: model_t
  implicit none
  private
  public :: weaken_beside, visit_flaws

contains

  !> Weakens the undamaged points of an interface beside cracks of a ply.
  pure subroutine weaken_beside(interfaces, model, zone, cracked, reach, part)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(model_t), intent(in) :: model
    !> Index of the zone
    integer, intent(in) :: zone
    !> True for cells of the mesh in which the ply has cracked, those of all ranks
    logical, intent(in) :: cracked(:)
    !> Distance from a crack that is weakened, length
    real(wp), intent(in) :: reach
    !> Part of the strengths that cracks leave
    real(wp), intent(in) :: part
    integer :: i

    if (.not. any(cracked)) return
    do i = 1, model%distribution%owned
      if (model%zone(i) /= zone .or. interfaces%strength(i) <= part .or. interfaces%points(i)%damage > 0) cycle
      associate (place => model%mesh%node_coordinates(:, model%mesh%point_node(model%distribution%points(i))))
        if (is_beside(model%mesh, cracked, place, reach)) interfaces%strength(i) = part
      end associate
    end do
  end subroutine weaken_beside

  !> True if a cracked cell lies within a distance. Mirrored cells lie farther away than the cells themselves; beyond
  !> the line at which a turned plate is cut lies the plate itself, turned.
  pure logical function is_beside(mesh, cracked, place, reach)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> True for cracked cells, (cells)
    logical, intent(in) :: cracked(:)
    !> Coordinates of a point
    real(wp), intent(in) :: place(2)
    !> The distance
    real(wp), intent(in) :: reach

    is_beside = near(mesh, cracked, place, reach)
    if (is_beside) return
    if (mesh%halved(1) .and. .not. mesh%mirrored(1)) is_beside = near(mesh, cracked, -place, reach)
  end function is_beside

  !> True if a cracked cell of the model lies within a distance.
  pure logical function near(mesh, cracked, place, reach)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> True for cracked cells, (cells)
    logical, intent(in) :: cracked(:)
    !> Coordinates of a point
    real(wp), intent(in) :: place(2)
    !> The distance
    real(wp), intent(in) :: reach
    ! So that cells as far away as the reach count on every machine.
    real(wp), parameter :: slack = 1 + 1.0e-9_wp
    real(wp) :: across
    integer :: column, row

    near = .false.
    do row = 1, mesh%cells(2)
      across = distance(place(2), mesh%y_edges(row:row + 1))
      if (across > slack*reach) cycle
      do column = 1, mesh%cells(1)
        if (.not. cracked(mesh%cell_at(column, row))) cycle
        near = norm2([distance(place(1), mesh%x_edges(column:column + 1)), across]) <= slack*reach
        if (near) return
      end do
    end do
  end function near

  !> Distance of a coordinate from an interval.
  pure real(wp) function distance(x, ends)
    !> The coordinate, and the ends of the interval
    real(wp), intent(in) :: x, ends(2)

    distance = max(0.0_wp, ends(1) - x, x - ends(2))
  end function distance

  !> Saves or loads.
  subroutine visit_flaws(interfaces, archive, model)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    real(wp), allocatable :: fields(:, :)

    if (.not. allocated(interfaces%strength)) return
    if (.not. any(model%scene%delaminations%cracks_as_flaws .or. model%scene%delaminations%shear_cracks)) return
    fields = reshape(interfaces%strength, [1, size(interfaces%strength)])
    associate (share => model%distribution)
      call archive%field('cohesive/strength', share%points(:share%owned), model%mesh%points(), fields)
    end associate
    if (archive%loading) interfaces%strength = fields(1, :)
  end subroutine visit_flaws
end module interface_flaws
