!> Builds the model of a setup: its plate, loads and supports on this rank.
module model_building
  use communicators, only: communicator_t
  use composite_plates, only: composite_plate_t
  use delamination_parameters, only: contact_augmented_lagrangian
  use errors, only: error_t
  use kinds, only: wp
  use model_loads, only: build_loads
  use models, only: model_t
  use placed_lines, only: place_line
  use placed_stringers, only: stiffness_on_line
  use plate_building, only: create_plate
  use rig_models, only: new_rig_model
  use setups, only: setup_t
  use stacking, only: section_of, section_t
  use surface_contact, only: create_contact_law
  implicit none
  private
  public :: create_model

  !> Stiffness of a rigid frame where its edge crosses a cell, relative to that of the laminate through its thickness:
  !> its effect on the deflection is far below round-off and tolerance, and the conditioning of the matrix is that of
  !> tied jumps.
  real(wp), parameter :: rigid = 1.0e3_wp

contains

  !> Builds the model of a setup. Collective.
  subroutine create_model(setup, communicator, self, error)
    !> The setup; it has passed the deck's checks
    type(setup_t), intent(in) :: setup
    type(communicator_t), intent(in) :: communicator
    type(model_t), intent(out) :: self
    !> Set if the mesh cannot be distributed or an element is ill-shaped; the same on every rank
    type(error_t), allocatable, intent(out) :: error

    call create_plate(setup, communicator, self%plate, error)
    if (allocated(error)) return
    call build_loads(self)
    call build_lines(self)
    if (allocated(setup%supports)) call build_rigs(self)
    self%has_point_stiffness = self%plate%map%layered .or. self%rig%unilateral .or. self%rig%elastic
  end subroutine create_model

  !> Lines on this rank's points.
  subroutine build_lines(self)
    type(model_t), intent(inout) :: self
    integer :: i

    allocate (self%loads%lines(0))
    associate (plate => self%plate)
      if (.not. allocated(plate%setup%lines)) return
      self%loads%lines = [(place_line(plate%setup%lines(i), plate%mesh, plate%distribution, plate%map, &
                                      plate%constraints%fixed(:, plate%distribution%points), &
                                      plate%layup%laminates(1)%plies, sections_of(plate), &
                                      plate%setup%plate%symmetry), i=1, size(plate%setup%lines))]
      do i = 1, size(self%loads%lines)
        associate (line => self%loads%lines(i))
          line%stiffness = line%stiffness + stiffness_on_line(plate, plate%setup%lines(i))
        end associate
      end do
    end associate
  end subroutine build_lines

  !> Section of each laminate of a plate.
  pure function sections_of(plate) result(sections)
    type(composite_plate_t), intent(in) :: plate
    type(section_t) :: sections(size(plate%layup%laminates))
    integer :: i

    sections = [(section_of(plate%layup%laminates(i)%plies, plate%setup%laminate%shear_correction), &
                 i=1, size(sections))]
  end function sections_of

  !> Supports of this rank's points by rigs, and the contact with unilateral frames: that of the laminate's face with a
  !> rigid one.
  subroutine build_rigs(self)
    type(model_t), intent(inout) :: self
    integer :: i

    associate (plate => self%plate, setup => self%plate%setup, mesh => self%plate%mesh, &
               layup => self%plate%layup, partition => self%plate%distribution)
      ! Stiffness of a rigid frame: the contact multiple of the laminate's through-thickness stiffness over the area of
      ! a cell.
      self%rig = new_rig_model(mesh, setup%plate, setup%supports, partition, &
                               rigid*layup%laminates(1)%plies(1)%elasticity%e2/layup%thickness &
                               *product(setup%plate%length/setup%mesh%elements)/mesh%multiplicity)
      if (allocated(self%rig%line_rig)) call self%rig%join_ranks(plate%communicator, plate%halo)
      if (.not. self%rig%unilateral) return
      self%rig_area = plate%nodal_areas(pack([(i, i=1, plate%elements%elements)], mesh%is_top(partition%elements)))
      associate (last => layup%laminates(1)%plies(mesh%plies))
        self%rig_law = create_contact_law(contact_augmented_lagrangian, 1.0_wp, last%elasticity%e2/layup%thickness, &
                                          layup%thickness, moving=setup%has_inertia())
      end associate
    end associate
  end subroutine build_rigs
end module model_building
