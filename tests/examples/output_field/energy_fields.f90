!> A field for the results: the strain energy of each element per area of the plate.
module energy_fields
  use composite_plates, only: composite_plate_t
  use element_batches, only: lanes, first_element
  use errors, only: error_t
  use fields_file, only: fields_file_t
  use kinds, only: wp
  use output_parameters, only: output_t
  use result_tables, only: result_row_length
  use strain_recovery, only: gauss_strains
  implicit none
  private
  public :: strain_energy_density, write_energy_fields

  !> The field.
  character(len=result_row_length), parameter, public :: energy_field_rows(*) = [character(len=result_row_length) :: &
    'strain_energy_density | cells | energy/area | energy | - | Strain energy of the element per area of the plate.']

contains

  !> Writes the field if it is requested.
  subroutine write_energy_fields(plate, stiffness, displacement, output, fields, error)
    type(composite_plate_t), intent(in) :: plate
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Which fields
    type(output_t), intent(in) :: output
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (output%requests('energy')) call fields%write_cell_field( &
      'strain_energy_density', strain_energy_density(plate, stiffness, displacement), error)
  end subroutine write_energy_fields

  !> Strain energy per area, with the current stiffness of the plies.
  function strain_energy_density(plate, stiffness, displacement) result(density)
    type(composite_plate_t), intent(in) :: plate
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Energy per area, in the form of a field over cells: (1, elements)
    real(wp), allocatable :: density(:, :)
    real(wp), allocatable :: motion(:, :)
    real(wp) :: strains(lanes, 9, 8), energy
    integer :: b, lane, point

    allocate (density(1, plate%elements%elements), source=0.0_wp)
    motion = plate%motion_of(displacement)
    do b = 1, plate%elements%batches
      call gauss_strains(plate%elements, b, plate%setup%mesh%kinematics, motion, strains)
      do lane = 1, plate%elements%lanes_used(b)
        energy = 0
        do point = 1, 9
          energy = energy + plate%elements%weight(lane, point, b) &
                   *packed_energy(stiffness(lane, :, b), strains(lane, point, :))
        end do
        density(1, first_element(b) + lane - 1) = energy/sum(plate%elements%weight(lane, :, b))
      end do
    end do
  end function strain_energy_density

  !> Strain energy per area of generalised strains.
  pure real(wp) function packed_energy(c, e) result(energy)
    !> Section stiffness: A, B, D (11, 12, 16, 22, 26, 66 each), S (xz-xz, xz-yz, yz-yz)
    real(wp), intent(in) :: c(21)
    !> Membrane strains, curvatures, transverse shear strains
    real(wp), intent(in) :: e(8)

    energy = form(c(1:6), e(1:3), e(1:3))/2 + form(c(7:12), e(1:3), e(4:6)) + form(c(13:18), e(4:6), e(4:6))/2 &
             + c(19)*e(7)**2/2 + c(20)*e(7)*e(8) + c(21)*e(8)**2/2
  end function packed_energy

  !> Bilinear form of a packed symmetric matrix of order three.
  pure real(wp) function form(c, a, b)
    !> 11, 12, 16, 22, 26, 66
    real(wp), intent(in) :: c(6)
    !> Strains on both sides
    real(wp), intent(in) :: a(3), b(3)

    form = a(1)*(c(1)*b(1) + c(2)*b(2) + c(3)*b(3)) + a(2)*(c(2)*b(1) + c(4)*b(2) + c(5)*b(3)) &
           + a(3)*(c(3)*b(1) + c(5)*b(2) + c(6)*b(3))
  end function form
end module energy_fields
