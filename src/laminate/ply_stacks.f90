!> The plies of an element: which of the plate's plies, at which heights, and within which laminate. Elements with the
!> same plies at the same heights refer to one stack.
module ply_stacks
  use kinds, only: wp
  use material_parameters, only: material_t
  use mean_stiffnesses, only: in_bending
  use ply_shear, only: shear_of_plies, shear_shares_of
  use plies, only: elasticity_t, ply_t
  use stacking, only: layer_stiffness, section_mass, section_t
  implicit none
  private
  public :: ply_stack_t, whole_stack

  !> Plies from the struck face down.
  type :: ply_stack_t
    !> Number of each ply among those of the plate
    integer, allocatable :: number(:)
    !> Position of each ply in the order of the layers, ascending: its number, for a ply bonded rigidly to a face that
    !> of the outermost ply of the laminate there, for one bonded by an interface the next number beyond it
    integer, allocatable, private :: station(:)
    !> The plies, with their heights here
    type(ply_t), allocatable :: plies(:)
    !> All plies through the thickness here
    type(ply_t), allocatable, private :: through(:)
    !> Position of the first ply of the stack among them
    integer, private :: first = 1
    !> Transverse shear stresses of the plies under unit shear forces of the laminate, (2, 2, plies)
    real(wp), allocatable, private :: shear_shares(:, :, :)
    !> shear_five_sixths or shear_energy
    integer, private :: shear_correction = 0
  contains
    procedure :: layer
    procedure :: set_thermal_strains
    procedure :: places
    procedure :: place
    procedure :: has
    procedure :: lies_within
    procedure :: section
    procedure :: stiffness
    procedure :: shear_stresses
  end type ply_stack_t

contains

  !> The plies through the thickness of the plate.
  pure function whole_stack(number, plies, shear_correction, station) result(self)
    !> Number of each ply among those of the plate
    integer, intent(in) :: number(:)
    !> The plies, with their heights
    type(ply_t), intent(in) :: plies(:)
    integer, intent(in) :: shear_correction
    !> Position of each ply in the order of the layers, ascending; absent: its number
    integer, intent(in), optional :: station(:)
    type(ply_stack_t) :: self

    self%number = number
    self%station = number
    if (present(station)) self%station = station
    self%plies = plies
    self%through = plies
    self%shear_shares = shear_shares_of(in_bending(plies))
    self%shear_correction = shear_correction
  end function whole_stack

  !> The plies of a stack from one position in the order of the layers to another: a layer of it.
  pure function layer(self, first, last)
    class(ply_stack_t), intent(in) :: self
    !> The positions
    integer, intent(in) :: first, last
    type(ply_stack_t) :: layer
    integer :: from, to

    from = count(self%station < first) + 1
    to = count(self%station <= last)
    layer = ply_stack_t(self%number(from:to), self%station(from:to), self%plies(from:to), self%through, &
                        self%first + from - 1, self%shear_shares(:, :, from:to), self%shear_correction)
  end function layer

  !> Sets the stress-free strains of the plies for a change of temperature.
  pure subroutine set_thermal_strains(self, materials, change)
    class(ply_stack_t), intent(inout) :: self
    !> Materials of the plies
    type(material_t), intent(in) :: materials(:)
    !> Temperature minus the stress-free one
    real(wp), intent(in) :: change
    integer :: i

    do i = 1, size(self%plies)
      self%plies(i)%free_strain(:2) = change*materials(self%plies(i)%material)%expansion
    end do
    self%through = self%plies
  end subroutine set_thermal_strains

  !> First and last ply of a stack among all plies through the thickness.
  pure function places(self)
    class(ply_stack_t), intent(in) :: self
    integer :: places(2)

    places = self%first + [0, size(self%plies) - 1]
  end function places

  !> Place in the stack of a ply of the plate; 0: it is not one of the stack.
  pure integer function place(self, ply)
    class(ply_stack_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: ply

    place = findloc(self%number, ply, dim=1)
  end function place

  !> True if a ply of the plate is one of the stack.
  pure logical function has(self, ply)
    class(ply_stack_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: ply

    has = self%place(ply) > 0
  end function has

  !> True if all plies of a stack belong to layers between two positions.
  pure logical function lies_within(self, first, last)
    class(ply_stack_t), intent(in) :: self
    !> The positions
    integer, intent(in) :: first, last

    lies_within = self%station(1) >= first .and. self%station(size(self%station)) <= last
  end function lies_within

  !> Stiffness and mass without damage.
  pure function section(self)
    class(ply_stack_t), intent(in) :: self
    type(section_t) :: section

    section%stiffness = self%stiffness(self%plies%elasticity)
    section%mass = section_mass(self%plies)
  end function section

  !> Stiffness with elastic constants that may have been reduced.
  pure function stiffness(self, elasticity)
    class(ply_stack_t), intent(in) :: self
    !> Present constants of the plies of the stack
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Packed as in section_t
    real(wp) :: stiffness(21)

    stiffness = layer_stiffness(self%through, elasticity, self%first, self%first + size(self%plies) - 1, &
                                self%shear_correction)
  end function stiffness

  !> Mean tau_xz and tau_yz of the plies under a shear force of the stack.
  pure function shear_stresses(self, force) result(stresses)
    class(ply_stack_t), intent(in) :: self
    !> Qx and Qy per length
    real(wp), intent(in) :: force(2)
    !> (2, plies)
    real(wp) :: stresses(2, size(self%plies))

    stresses = shear_of_plies(self%plies, self%shear_shares, force)
  end function shear_stresses
end module ply_stacks
