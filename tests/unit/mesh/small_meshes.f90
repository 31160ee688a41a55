!> Small meshes for the tests of distributions and numberings.
module small_meshes
  use kinds, only: wp
  use mesh_parameters, only: plate_t, mesh_t
  use interface_zones, only: zone_t
  use layered_meshes, only: create_mesh, layered_mesh_t
  implicit none
  private
  public :: meshed, plain_mesh, zoned_mesh

contains

  !> Five by four cells, one layer.
  pure function plain_mesh() result(mesh)
    !> The mesh
    type(layered_mesh_t) :: mesh
    type(zone_t) :: none(0)

    mesh = meshed(none)
  end function plain_mesh

  !> The same with two zones that overlap.
  pure function zoned_mesh() result(mesh)
    !> The mesh
    type(layered_mesh_t) :: mesh

    mesh = meshed([zone_t(1, [2, 4], [2, 3]), zone_t(3, [1, 3], [1, 4])])
  end function zoned_mesh

  !> Five by four cells with zones.
  pure function meshed(zones) result(mesh)
    !> The zones
    type(zone_t), intent(in) :: zones(:)
    !> The mesh
    type(layered_mesh_t) :: mesh
    type(plate_t) :: plate
    type(mesh_t) :: parameters

    plate%length = [5.0_wp, 4.0_wp]
    parameters%elements = [5, 4]
    mesh = create_mesh(plate, parameters, 4, zones)
  end function meshed
end module small_meshes
