!> The plate of composite: its discretization with plies and interfaces, without loads. Plies, interfaces and results
!> that need no more of a model take it.
module composite_plates
  use cohesive_laws, only: cohesive_law_t
  use discretizations, only: discretization_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use ply_stacks, only: ply_stack_t
  use setups, only: setup_t
  use stacking, only: section_t
  use surface_contact, only: contact_law_t
  implicit none
  private
  public :: composite_plate_t

  !> Fraction of the stiffness of the plate's lowest bending wave that is negligible in an operator: with exact
  !> residuals, the corrections of elastic modes are then exact to a thousandth.
  real(wp), parameter :: negligible_share = 1.0e-3_wp

  !> A discretization with the setup, laminates and laws of interfaces of its plate. It has many components because it
  !> has those of the discretization.
  type, extends(discretization_t) :: composite_plate_t
    !> The setup of the deck
    type(setup_t) :: setup
    !> Number of plies, those of doublers included
    integer :: plies = 0
    !> The different laminates of the plate, the skin's first
    type(ply_stack_t), allocatable :: laminates(:)
    !> The different stacks of elements, one for each layer of the mesh
    type(ply_stack_t), allocatable :: stacks(:)
    !> Stack of each of this rank's elements, (elements)
    integer, allocatable :: stack(:)
    !> Section of the full laminate, and the same with the bending moduli of plies with E1c
    type(section_t) :: section, bending_section
    !> Thickness of the laminate
    real(wp) :: thickness = 0
    !> Resultants of the thermal strains of undamaged plies, and their energy per area, (lanes, 7, batches); allocated
    !> only if they are modelled
    real(wp), allocatable :: free(:, :, :)
    !> Area of each point of a lower layer, (local points)
    real(wp), allocatable :: contact_area(:)
    !> Contact of each zone's surfaces
    type(contact_law_t), allocatable :: contact_laws(:)
    !> Cohesive law of each zone; not used where fronts release ties
    type(cohesive_law_t), allocatable :: cohesive_laws(:)
  contains
    procedure :: negligible_stiffness
  end type composite_plate_t

contains

  !> Stiffness per area that is negligible in an operator but keeps it from being singular (doc/theory/newton.md,
  !> assumptions): a small fraction of that of the plate's lowest bending wave, D (pi/L)^4 with the smaller bending
  !> stiffness D and the longer side L.
  pure real(wp) function negligible_stiffness(self) result(stiffness)
    class(composite_plate_t), intent(in) :: self

    stiffness = negligible_share*min(self%section%stiffness(13), self%section%stiffness(16)) &
                *(pi/maxval(self%setup%plate%length))**4
  end function negligible_stiffness
end module composite_plates
