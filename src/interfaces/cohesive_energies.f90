!> Energy error of cohesive points in a step by the implicit steps' quadrature of the work of tractions.
module cohesive_energies
  use cohesive_surfaces, only: cohesive_surfaces_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: stored_beyond_work

contains

  !> Change of the energy stored by this rank's points in a step minus the work of the mean tractions; negative where
  !> they dissipate.
  pure real(wp) function stored_beyond_work(self, plate, old, before, after) result(energy)
    !> The interfaces at the end of the step
    type(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The interfaces at its start
    type(cohesive_interfaces_t), intent(in) :: old
    !> Unknowns before and after it, (5, points)
    real(wp), intent(in) :: before(:, :), after(:, :)
    type(cohesive_surfaces_t) :: surfaces
    type(cohesive_point_t) :: start, point
    real(wp) :: traction(3, 2)
    integer :: i

    energy = 0
    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (.not. self%cohesive(i)) cycle
      surfaces = old%surfaces_of(plate, i)
      start = old%points(i)
      call surfaces%traction(before(1:3, i), start, traction(:, 1), point)
      start%sliding%limit = self%points(i)%sliding%limit
      call surfaces%traction(after(1:3, i), start, traction(:, 2), point)
      energy = energy + plate%interfaces%contact_area(i)*( &
        surfaces%stored(after(1:3, i), self%points(i)) - surfaces%stored(before(1:3, i), old%points(i)) - &
        dot_product(sum(traction, 2)/2, after(1:3, i) - before(1:3, i)))
    end do
  end function stored_beyond_work
end module cohesive_energies
