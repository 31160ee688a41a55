!> Transverse shear forces of the stacks of tied layers.
module joined_stacks
  use element_batches, only: first_element, lanes
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use strain_recovery, only: nodal_strains
  implicit none
  private
  public :: joined_stacks_t, joined_stacks_of

  !> Stack of tied layers of each element of the mesh.
  type :: joined_stacks_t
    !> First and last ply, (2, elements of the mesh)
    integer, allocatable :: plies(:, :)
    !> Qx and Qy, summed over the layers, (2, elements of the mesh)
    real(wp), allocatable :: force(:, :)
    !> Their derivatives along x and y (rows), (2, 2, elements of the mesh)
    real(wp), allocatable :: gradient(:, :, :)
  end type joined_stacks_t

contains

  !> Stacks of a state. Layers are treated as tied in a cell if less than half of the area between them has delaminated.
  !> Collective; the same on every rank.
  function joined_stacks_of(plate, stiffness, delaminated, displacement) result(self)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Delaminated fraction of the area above each element, (1, elements)
    real(wp), intent(in) :: delaminated(:, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    type(joined_stacks_t) :: self
    real(wp), allocatable :: layers(:, :)
    integer :: cell, first, last, range(4)

    layers = gathered(plate, stiffness, delaminated, displacement)
    allocate (self%plies(2, size(layers, 2)), self%force(2, size(layers, 2)), self%gradient(2, 2, size(layers, 2)))
    associate (mesh => plate%mesh)
      do cell = 1, product(mesh%cells)
        first = mesh%first_element(cell)
        do while (first < mesh%first_element(cell + 1))
          last = first
          do while (last + 1 < mesh%first_element(cell + 1))
            if (layers(7, last + 1) >= 0.5_wp) exit
            last = last + 1
          end do
          range = [mesh%plies_of(first), mesh%plies_of(last)]
          self%plies(:, first:last) = spread(range([1, 4]), 2, last - first + 1)
          self%force(:, first:last) = spread(sum(layers(1:2, first:last), 2), 2, last - first + 1)
          self%gradient(:, :, first:last) = spread(reshape(sum(layers(3:6, first:last), 2), [2, 2]), 3, &
                                                   last - first + 1)
          first = last + 1
        end do
      end do
    end associate
  end function joined_stacks_of

  !> Shear forces, their derivatives and delaminated fractions of all elements of the mesh. Collective.
  function gathered(plate, stiffness, delaminated, displacement) result(everywhere)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Delaminated fraction of the area above each element, (1, elements)
    real(wp), intent(in) :: delaminated(:, :)
    real(wp), intent(in) :: displacement(:, :)
    !> Qx, Qy; Qx,x Qx,y Qy,x Qy,y; delaminated fraction, (7, elements of the mesh)
    real(wp), allocatable :: everywhere(:, :)
    real(wp), allocatable :: motion(:, :)
    real(wp) :: strains(lanes, 9, 8)
    integer :: b, lane, i

    allocate (everywhere(7, plate%mesh%elements()), source=0.0_wp)
    motion = plate%motion_of(displacement)
    do b = 1, plate%elements%batches
      call nodal_strains(plate%elements, b, plate%setup%mesh%kinematics, motion, strains)
      do lane = 1, plate%elements%lanes_used(b)
        i = first_element(b) + lane - 1
        associate (element => plate%distribution%elements(i))
          everywhere(:6, element) = shear_forces(stiffness(lane, 19:21, b), strains(lane, :, 7:8), &
            plate%mesh%cell_sides(plate%mesh%place_of(plate%mesh%element_cell(element))))
          everywhere(7, element) = delaminated(1, i)
        end associate
      end do
    end do
    call plate%communicator%sum(everywhere)
  end function gathered

  !> Shear forces in the middle of an element and their derivatives.
  pure function shear_forces(stiffness, strains, sides) result(forces)
    !> xz-xz, xz-yz, yz-yz
    real(wp), intent(in) :: stiffness(3)
    !> Shear strains of the nodes, bilinear, (9, 2)
    real(wp), intent(in) :: strains(:, :)
    !> Sides of the element along x and y
    real(wp), intent(in) :: sides(2)
    !> Qx, Qy; Qx,x Qx,y Qy,x Qy,y
    real(wp) :: forces(6)
    real(wp) :: values(3, 2)

    values(1, :) = strains(5, :)
    values(2, :) = (strains(6, :) - strains(4, :))/sides(1)
    values(3, :) = (strains(8, :) - strains(2, :))/sides(2)
    values = matmul(values, reshape([stiffness(1), stiffness(2), stiffness(2), stiffness(3)], [2, 2]))
    forces = [values(1, :), values(2:3, 1), values(2:3, 2)]
  end function shear_forces
end module joined_stacks
