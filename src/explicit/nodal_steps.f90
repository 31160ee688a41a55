!> Data that determine the motion of the nodes in a step by central differences: inertia, forces, interfaces, and
!> constraints.
module nodal_steps
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use line_steps, only: line_steps_t
  use nodal_inertia, only: nodal_inertia_t
  use rig_steps, only: rig_steps_t
  use stack_batches, only: stack_batches_t
  use step_lengths, only: step_lengths_t
  implicit none
  private
  public :: nodal_steps_t

  !> The nodes in a step.
  type :: nodal_steps_t
    !> Lumped inertia of the points, inverted for the step
    type(nodal_inertia_t) :: inertia
    !> Forces on the layers without tractions, (5, points); at the end of a step loads minus internal forces
    real(wp), allocatable :: force(:, :)
    !> Nodes with several layers
    type(interface_stacks_t) :: stacks
    !> Batches of stacks; unallocated: to be formed for the step
    type(stack_batches_t), allocatable :: batches
    !> Lines
    type(line_steps_t) :: lines
    !> Frames and springs
    type(rig_steps_t) :: rigs
    !> The step taken last and the one before it
    type(step_lengths_t) :: steps
  end type nodal_steps_t
end module nodal_steps
