!> Output parameters: content, frequency and folder.
module output_parameters
  use kinds, only: wp
  implicit none
  private
  public :: output_t

  !> Names of the fields, by which the deck chooses them.
  character(len=*), parameter, public :: &
    field_displacement = 'displacement', field_rotation = 'rotation', field_velocity = 'velocity', &
    field_gap = 'gap', field_contact_pressure = 'contact_pressure', field_delamination = 'delamination', &
    field_energy_release = 'energy_release', field_ply_damage = 'ply_damage', field_stress = 'stress', &
    field_face_stress = 'face_stress', field_onset = 'onset'

  !> Outputs; an interval of 0 means never (fields, checkpoint) or every accepted step (history).
  type :: output_t
    !> Folder of the results, created if it does not exist
    character(len=:), allocatable :: directory
    !> Time between rows of the history; 0: every accepted step
    real(wp) :: history_every = 0
    !> Accepted steps between rows without a time interval
    integer :: steps_between_rows = 1
    !> Time between fields written; 0: only the last
    real(wp) :: fields_every = 0
    !> Time between checkpoints; 0: none but at a queue's signal
    real(wp) :: checkpoint_every = 0
    !> True: a checkpoint is written at the end of the run, from which another deck may start
    logical :: checkpoint_at_end = .true.
    !> Corner frequency of the low pass for the contact force; 0: none
    real(wp) :: force_filter = 0
    !> Names of the requested fields, in lower case, separated by commas without blanks
    character(len=:), allocatable :: fields
  contains
    procedure :: requests
  end type output_t

contains

  !> True if a field is requested.
  pure logical function requests(self, field)
    class(output_t), intent(in) :: self
    !> Name of the field
    character(len=*), intent(in) :: field

    requests = index(','//self%fields//',', ','//field//',') > 0
  end function requests
end module output_parameters
