!> The setup of a deck as plain parameters: a plate and its load case.
module setups
  use hertz_contact, only: relative_radius
  use kinds, only: wp
  use mesh_parameters, only: plate_t, mesh_t, curvatures
  use stringers, only: stringer_t
  use load_cases, only: load_case_t
  use material_parameters, only: material_t, modulus_differs
  use laminate_parameters, only: laminate_t
  use ply_damage_parameters, only: ply_damage_t
  use ply_stacks, only: ply_stack_t
  use ply_zones, only: ply_zones_t
  use delamination_parameters, only: delamination_t
  implicit none
  private
  public :: setup_t

  !> A load case and its plate: geometry, mesh, laminate and damage.
  type, extends(load_case_t) :: setup_t
    type(plate_t) :: plate
    !> Mesh and element
    type(mesh_t) :: mesh
    type(material_t), allocatable :: materials(:)
    !> Stacking
    type(laminate_t) :: laminate
    !> Rectangles with further or missing plies
    type(ply_zones_t) :: zones
    !> Stringers; unallocated: none
    type(stringer_t), allocatable :: stringers(:)
    !> Damage of the plies
    type(ply_damage_t) :: ply_damage
    !> Interfaces that may delaminate, from the struck face downwards; unallocated: none
    type(delamination_t), allocatable :: delaminations(:)
  contains
    procedure :: plies
    procedure :: used_materials
    procedure :: all_plies
    procedure :: struck_laminate
    procedure :: struck_stack
    procedure :: has_crack_bands
    procedure :: is_bimodular
    procedure :: has_rates
    procedure :: counts_rates
    procedure :: has_variable_sections
    procedure :: contact_radius
  end type setup_t

contains

  !> Number of plies, those of doublers included.
  pure integer function plies(self)
    class(setup_t), intent(in) :: self

    plies = size(self%laminate%material) + self%zones%plies()
  end function plies

  !> Index of the material of each ply, those of doublers included.
  pure function used_materials(self) result(indices)
    class(setup_t), intent(in) :: self
    integer, allocatable :: indices(:)

    allocate (indices(0))
    if (allocated(self%laminate%material)) indices = [self%laminate%material, self%zones%material()]
  end function used_materials

  !> All plies in the order of their numbers, those of doublers included, as one list.
  pure function all_plies(self) result(list)
    class(setup_t), intent(in) :: self
    type(laminate_t) :: list
    integer :: i

    list = self%laminate
    if (.not. allocated(self%zones%doublers)) return
    do i = 1, size(self%zones%doublers)
      associate (added => self%zones%doublers(i)%laminate)
        list%material = [list%material, added%material]
        list%angle = [list%angle, added%angle]
        list%thickness = [list%thickness, added%thickness]
      end associate
    end do
  end function all_plies

  !> Plies at the struck point, or at the plate's centre without an impactor, as a laminate of their own.
  pure function struck_laminate(self) result(laminate)
    class(setup_t), intent(in) :: self
    type(laminate_t) :: laminate

    laminate = self%laminate
    if (.not. self%zones%is_empty()) laminate = self%zones%laminate_of(laminate, self%zones%at(self%mesh%struck))
  end function struck_laminate

  !> The same plies with their numbers among those of the plate, at their heights there.
  pure function struck_stack(self) result(stack)
    class(setup_t), intent(in) :: self
    type(ply_stack_t) :: stack

    stack = self%zones%stack(self%laminate, self%materials, self%zones%at(self%mesh%struck))
  end function struck_stack

  !> True: plies soften by their fracture energies, instead of sudden failure.
  pure logical function has_crack_bands(self)
    class(setup_t), intent(in) :: self
    integer :: i

    has_crack_bands = .false.
    if (.not. self%ply_damage%is_present) return
    associate (used => self%used_materials())
      has_crack_bands = all([(all(self%materials(used(i))%toughness > 0), i=1, size(used))])
    end associate
  end function has_crack_bands

  !> True: the moduli along the fibres in tension and in compression of a ply differ.
  pure logical function is_bimodular(self)
    class(setup_t), intent(in) :: self
    integer :: i

    is_bimodular = .false.
    if (.not. (allocated(self%laminate%material) .and. allocated(self%materials))) return
    associate (used => self%used_materials())
      is_bimodular = any([(modulus_differs(self%materials(used(i))), i=1, size(used))])
    end associate
  end function is_bimodular

  !> True: the matrix strengths of softening plies depend on the strain rate.
  pure logical function has_rates(self)
    class(setup_t), intent(in) :: self

    has_rates = .false.
    if (self%has_crack_bands()) has_rates = any(self%materials%rate_gain > 0)
  end function has_rates

  !> True: the strain rates of the run are those of its test. Load steps have none, and motions that are prescribed in
  !> time are faster than the test that they stand for.
  pure logical function counts_rates(self)
    class(setup_t), intent(in) :: self

    counts_rates = self%has_rates() .and. .not. self%is_static() .and. (self%is_impact() .or. self%pressure%is_present)
  end function counts_rates

  !> True: the sections of the elements depend on their state, by failure of plies or the sign of their stresses.
  pure logical function has_variable_sections(self)
    class(setup_t), intent(in) :: self

    has_variable_sections = self%ply_damage%is_present .or. self%is_bimodular()
  end function has_variable_sections

  !> Radius of the sphere that touches a flat plate as the nose touches this one; 0: the nose has no radius.
  pure real(wp) function contact_radius(self)
    class(setup_t), intent(in) :: self

    contact_radius = relative_radius(self%impactor%radius, curvatures(self%plate))
  end function contact_radius
end module setups
