!> The setup of a deck as plain parameters. Physics that it does not have costs nothing.
module setups
  use plate_options, only: kinematics_von_karman
  use mesh_parameters, only: plate_t, mesh_t
  use support_parameters, only: support_t
  use gauges, only: gauge_t
  use kinds, only: wp
  use material_parameters, only: material_t
  use laminate_parameters, only: laminate_t
  use ply_damage_parameters, only: ply_damage_t
  use delamination_parameters, only: delamination_t
  use impact_parameters, only: impactor_parameters_t, indentation_law_t
  use line_loads, only: line_load_t
  use smooth_starts, only: smooth_step
  use pressure_loads, only: pressure_t
  implicit none
  private
  public :: setup_t

  !> One setup, with many components because a deck has that many groups.
  type :: setup_t
    !> kinematics_von_karman or kinematics_linear
    integer :: kinematics = kinematics_von_karman
    !> Plate, mesh, materials and stacking
    type(plate_t) :: plate
    !> Mesh and element
    type(mesh_t) :: mesh
    !> Rigs under the plate; unallocated: none
    type(support_t), allocatable :: supports(:)
    !> Materials
    type(material_t), allocatable :: materials(:)
    !> Stacking
    type(laminate_t) :: laminate
    !> Which groups the deck has
    logical :: has_impactor = .false., has_indentation = .false., has_pressure = .false., has_static = .false., &
               has_ply_damage = .false., has_thermal = .false.
    !> Impactor
    type(impactor_parameters_t) :: impactor
    !> Indentation law
    type(indentation_law_t) :: indentation
    !> Pressure
    type(pressure_t) :: pressure
    !> Temperature less that at which the plies were joined without stress
    real(wp) :: temperature_change = 0
    !> Lines across the plate; unallocated: none
    type(line_load_t), allocatable :: lines(:)
    !> Strain gauges; unallocated: none
    type(gauge_t), allocatable :: gauges(:)
    !> True: the plate begins in the state that another run has left
    logical :: inherits = .false.
    !> Time at which lines begin to load, and in which their ramps then reach their full value; a static analysis does
    !> not use them
    real(wp) :: load_start = 0, ramp_time = 1
    !> Damage of the plies
    type(ply_damage_t) :: ply_damage
    !> Interfaces that may delaminate, from the struck face downwards; unallocated: none
    type(delamination_t), allocatable :: delaminations(:)
  contains
    !> True: plies soften by their fracture energies.
    procedure :: has_crack_bands
    !> Ramps of lines over their full values at a time.
    procedure :: load_factor_at
    !> Factor of initial deformations that supports and lines do not have.
    procedure :: offset_left
  end type setup_t

contains

  !> True: plies soften by their fracture energies, instead of losing stiffness at once.
  pure logical function has_crack_bands(self)
    !> The setup
    class(setup_t), intent(in) :: self
    integer :: i

    has_crack_bands = .false.
    if (.not. self%has_ply_damage) return
    has_crack_bands = all([(all(self%materials(self%laminate%material(i))%toughness > 0), &
                            i=1, size(self%laminate%material))])
  end function has_crack_bands

  !> Ramps of lines over their full values at a time of a run by central differences.
  pure real(wp) function load_factor_at(self, time) result(load_factor)
    !> The setup
    class(setup_t), intent(in) :: self
    !> The time
    real(wp), intent(in) :: time

    load_factor = max(0.0_wp, time - self%load_start)/self%ramp_time
  end function load_factor_at

  !> Factor at a time of initial deformations that supports and lines do not have: it decreases smoothly to zero until
  !> these begin to load, and is constant without time for that.
  pure real(wp) function offset_left(self, time) result(left)
    !> The setup
    class(setup_t), intent(in) :: self
    !> The time
    real(wp), intent(in) :: time

    left = 1
    if (self%load_start > 0) left = 1 - smooth_step(time/self%load_start, 0)
  end function offset_left
end module setups
