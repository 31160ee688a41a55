!> What is written, how often and where, as the deck says.
module output_parameters
  use kinds, only: wp
  implicit none
  private
  public :: output_t

  !> Outputs; an interval of 0 means never (fields, checkpoint) or every accepted step (history).
  type :: output_t
    !> Folder of the results, made if it is not there
    character(len=:), allocatable :: directory
    !> Time between rows of the history; 0: every accepted step
    real(wp) :: history_every = 0
    !> Time between fields written; 0: only the last
    real(wp) :: fields_every = 0
    !> Time between checkpoints; 0: none but at a queue's signal
    real(wp) :: checkpoint_every = 0
    !> Names of the fields wanted
    character(len=:), allocatable :: fields
  end type output_t
end module output_parameters
