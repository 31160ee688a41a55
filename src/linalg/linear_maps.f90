!> A matrix-free linear map of this rank's rows: a tangent or a preconditioner.
module linear_maps
  use errors, only: error_t
  use kinds, only: wp
  implicit none
  private
  public :: linear_map_t

  !> The map.
  type, abstract :: linear_map_t
  contains
    !> Product with a vector.
    procedure(map_product), deferred :: multiply
  end type linear_map_t

  abstract interface
    !> Product with a vector. Collective.
    subroutine map_product(self, vector, product, error)
      import :: linear_map_t, error_t, wp
      !> The map
      class(linear_map_t), intent(inout) :: self
      !> The vector, (rows)
      real(wp), intent(in) :: vector(:)
      !> The product, (rows)
      real(wp), intent(out) :: product(:)
      !> Set if it cannot be computed
      type(error_t), allocatable, intent(inout) :: error
    end subroutine map_product
  end interface
end module linear_maps
