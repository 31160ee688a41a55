!> Number and end of load steps.
module load_step_parameters
  use kinds, only: wp
  implicit none
  private
  public :: load_stepping_t

  !> Load steps.
  type :: load_stepping_t
    !> Number of equal load steps
    integer :: steps = 1
    !> Dissipated energy at which the analysis ends; 0: load control throughout
    real(wp) :: dissipation = 0
  end type load_stepping_t
end module load_step_parameters
