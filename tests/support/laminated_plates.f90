!> Setups of small carbon/epoxy plates, also with interfaces between all plies, for tests.
module laminated_plates
  use communicators, only: communicator_t
  use delamination_parameters, only: law_cohesive
  use errors, only: error_t
  use kinds, only: wp
  use material_parameters, only: material_t
  use mesh_parameters, only: edge_free, in_plane_free
  use model_building, only: create_model
  use models, only: model_t
  use plate_options, only: kinematics_linear, mass_lumped
  use setups, only: setup_t
  use stringer_sections, only: section_of_sizes
  use stringers, only: face_back, face_front, stringer_t
  implicit none
  private
  public :: laminated_plate, add_interfaces, add_stringers, scattered, build

contains

  !> A free carbon/epoxy plate of 40 mm by 30 mm with linear strains.
  pure function laminated_plate(angles, thickness, elements) result(setup)
    !> Angles of the plies, degrees, and thickness of them all
    real(wp), intent(in) :: angles(:), thickness
    !> Elements along both sides
    integer, intent(in) :: elements(2)
    !> The setup
    type(setup_t) :: setup
    type(material_t) :: material

    material%name = 'ply'
    material%density = 1580
    material%e1 = 139.0e9_wp
    material%e2 = 9.4e9_wp
    material%g12 = 4.5e9_wp
    material%g13 = 4.5e9_wp
    material%g23 = 2.98e9_wp
    material%nu12 = 0.309_wp
    setup%mesh%kinematics = kinematics_linear
    setup%plate%length = [0.04_wp, 0.03_wp]
    setup%plate%edges = edge_free
    setup%plate%in_plane = in_plane_free
    setup%mesh%elements = elements
    setup%mesh%mass = mass_lumped
    setup%materials = [material]
    allocate (setup%laminate%material(size(angles)), source=1)
    allocate (setup%laminate%thickness(size(angles)), source=thickness/size(angles))
    setup%laminate%angle = angles
  end function laminated_plate

  !> Adds cohesive interfaces between all plies over the full plate.
  pure subroutine add_interfaces(setup, strength, toughness)
    !> The setup
    type(setup_t), intent(inout) :: setup
    !> Strength, and toughness of opening and of shear
    real(wp), intent(in) :: strength, toughness(2)
    integer :: i

    allocate (setup%delaminations(size(setup%laminate%angle) - 1))
    do i = 1, size(setup%delaminations)
      setup%delaminations(i)%below_ply = i
      setup%delaminations(i)%law = law_cohesive
      setup%delaminations(i)%strength_opening = strength
      setup%delaminations(i)%strength_shear = strength
      setup%delaminations(i)%toughness_opening = toughness(1)
      setup%delaminations(i)%toughness_shear = toughness(2)
      setup%delaminations(i)%zone = 2*setup%plate%length
    end do
  end subroutine add_interfaces

  !> Adds a blade along x on the back and a T along y on the front, of aluminium, through the middle of the plate.
  pure subroutine add_stringers(setup)
    !> The setup
    type(setup_t), intent(inout) :: setup
    type(stringer_t) :: all(2)
    integer :: i

    do i = 1, 2
      all(i)%name = merge('blade', 'T    ', i == 1)
      all(i)%along = i
      all(i)%ends = [-setup%plate%length(i), setup%plate%length(i)]/2
      all(i)%face = merge(face_back, face_front, i == 1)
      all(i)%section = section_of_sizes([5.0e-3_wp, 1.0e-3_wp], &
                                        merge([4.0e-3_wp, 1.0e-3_wp], [0.0_wp, 0.0_wp], i == 2), &
                                        70.0e9_wp, 27.0e9_wp, 2700.0_wp)
    end do
    setup%stringers = all
  end subroutine add_stringers

  !> A pseudo-random number between -1 and 1 computed from another one.
  elemental real(wp) function scattered(number)
    !> The other number
    integer, intent(in) :: number

    scattered = sin(real(37*number, wp))
  end function scattered

  !> Builds the model of a setup.
  subroutine build(setup, model)
    !> The setup
    type(setup_t), intent(in) :: setup
    !> Its model on this rank alone
    type(model_t), intent(out) :: model
    type(communicator_t) :: alone
    type(error_t), allocatable :: error

    call create_model(setup, alone, model, error)
    if (allocated(error)) error stop 'There is no such plate.'
  end subroutine build
end module laminated_plates
