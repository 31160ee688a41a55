!> Shear strengths of all interfaces between plies.
module interface_strengths
  use delamination_parameters, only: delamination_t
  use kinds, only: wp
  use material_parameters, only: material_t
  use plies, only: ply_t
  use ply_blocks, only: are_alike
  implicit none
  private
  public :: shear_strengths

contains

  !> Shear strength of the interface below each ply: that of its cohesive law, else S12 of the weaker neighbour; none
  !> between plies that are alike.
  pure function shear_strengths(plies, materials, delaminations) result(strengths)
    !> All plies, from the struck face
    type(ply_t), intent(in) :: plies(:)
    !> Materials that they refer to
    type(material_t), intent(in) :: materials(:)
    !> Interfaces that may delaminate; not allocated: none
    type(delamination_t), allocatable, intent(in) :: delaminations(:)
    !> Strengths; 0: not known, or plies that are alike, (plies - 1)
    real(wp) :: strengths(size(plies) - 1)
    real(wp) :: beside(2)
    integer :: i

    strengths = 0
    do i = 1, size(strengths)
      beside = materials(plies(i:i + 1)%material)%s12
      if (all(beside > 0) .and. .not. are_alike(plies(i), plies(i + 1))) strengths(i) = minval(beside)
    end do
    if (.not. allocated(delaminations)) return
    do i = 1, size(delaminations)
      associate (interface => delaminations(i))
        if (interface%strength_shear > 0) strengths(interface%below_ply) = interface%strength_shear
      end associate
    end do
  end function shear_strengths
end module interface_strengths
