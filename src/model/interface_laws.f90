!> Laws of the interfaces between the layers of a mesh, and the areas of their points.
module interface_laws
  use cohesive_laws, only: cohesive_law_t, create_cohesive_law
  use delamination_parameters, only: delamination_t, law_cohesive, toughnesses
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use plies, only: ply_t
  use setups, only: setup_t
  use surface_contact, only: contact_law_t, create_contact_law
  implicit none
  private
  public :: interface_laws_t, new_interface_laws, law_between_plies

  !> Properties of the interfaces at this rank's points.
  type :: interface_laws_t
    !> Area of each point of a lower layer, (local points)
    real(wp), allocatable :: contact_area(:)
    !> True for points next to the border of their zone, where growth ends, (local points)
    logical, allocatable :: beside_border(:)
    !> Contact of each zone's surfaces
    type(contact_law_t), allocatable :: contact_laws(:)
    !> Cohesive law of each zone; not used where fronts release ties
    type(cohesive_law_t), allocatable :: cohesive_laws(:)
  end type interface_laws_t

contains

  !> Interfaces at some points of a mesh.
  pure function new_interface_laws(setup, mesh, plies, points, areas) result(self)
    type(setup_t), intent(in) :: setup
    type(layered_mesh_t), intent(in) :: mesh
    !> Plies of the skin
    type(ply_t), intent(in) :: plies(:)
    !> Points of this rank
    integer, intent(in) :: points(:)
    !> Areas of those of lower layers; 0 elsewhere
    real(wp), intent(in) :: areas(:)
    type(interface_laws_t) :: self
    real(wp) :: thickness
    integer :: zone, i

    self%contact_area = areas
    self%beside_border = [(beside_border(mesh, points(i)), i=1, size(points))]
    allocate (self%contact_laws(size(mesh%zones)), self%cohesive_laws(size(mesh%zones)))
    do zone = 1, size(mesh%zones)
      associate (height => mesh%zones(zone)%height, interface => setup%delaminations(zone), &
                 above => plies(max(1, mesh%zones(zone)%below_ply)))
        thickness = min(height - plies(1)%z_top, plies(size(plies))%z_bottom - height)
        if (interface%bonds_doublers()) &
          thickness = min(plies(size(plies))%z_bottom - plies(1)%z_top, mesh%zones(zone)%thickness)
        self%contact_laws(zone) = create_contact_law(interface%contact, interface%contact_exponent, &
                                                     above%elasticity%e2/thickness, thickness, &
                                                     moving=setup%has_inertia())
        if (interface%law == law_cohesive) &
          self%cohesive_laws(zone) = cohesive_law_of(interface, above%elasticity%e2, &
                                                     thickness/size(mesh%zones))
      end associate
    end do
  end function new_interface_laws

  !> Cohesive law of an interface between plies of the skin.
  pure type(cohesive_law_t) function law_between_plies(interface, plies, interfaces) result(law)
    !> The interface
    type(delamination_t), intent(in) :: interface
    !> Plies of the skin
    type(ply_t), intent(in) :: plies(:)
    !> Number of interfaces of the plate
    integer, intent(in) :: interfaces

    associate (above => plies(interface%below_ply))
      law = cohesive_law_of(interface, above%elasticity%e2, &
                            min(above%z_bottom - plies(1)%z_top, plies(size(plies))%z_bottom - above%z_bottom) &
                            /interfaces)
    end associate
  end function law_between_plies

  !> Cohesive law of an interface.
  pure type(cohesive_law_t) function cohesive_law_of(interface, modulus, thickness) result(law)
    !> The interface
    type(delamination_t), intent(in) :: interface
    !> E2 of the ply above it, thickness of the laminate on its thinner side over the number of interfaces
    real(wp), intent(in) :: modulus, thickness

    law = create_cohesive_law(toughnesses(interface), interface%mixing_exponent, &
                              [interface%strength_opening, interface%strength_shear], &
                              interface%stiffness, modulus, thickness)
  end function cohesive_law_of

  !> True if a point lies next to the border of its zone, except where this is the border of the model or the free edge
  !> of a doubler.
  pure logical function beside_border(mesh, point)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: point
    integer :: line(2)

    beside_border = .false.
    if (mesh%point_zone(point) == 0 .or. mesh%is_bond(point)) return
    line = [modulo(mesh%point_node(point) - 1, 2*mesh%cells(1) + 1), (mesh%point_node(point) - 1)/(2*mesh%cells(1) + 1)]
    associate (zone => mesh%zones(mesh%point_zone(point)))
      beside_border = near(line(1), zone%columns, mesh%cells(1)) .or. near(line(2), zone%rows, mesh%cells(2))
    end associate

  contains

    !> True if a line of nodes shares a cell with the first or last of a range of cells that ends within the model.
    pure logical function near(line, range, cells)
      !> Line of nodes, from 0
      integer, intent(in) :: line
      !> First and last cell of the range
      integer, intent(in) :: range(2)
      !> Cells along this direction
      integer, intent(in) :: cells

      near = range(1) > 1 .and. line <= 2*range(1) .or. range(2) < cells .and. line >= 2*range(2) - 2
    end function near
  end function beside_border
end module interface_laws
