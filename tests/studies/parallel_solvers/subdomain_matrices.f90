!> A matrix in subdomains of the ranks (MATIS) for domain decomposition, and the rigid motions of the plate for BDDC.
module subdomain_matrices
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use petscksp, only: tIS, tMatNullSpace, tPC, tVec, PETSC_COMM_SELF, PETSC_COPY_VALUES, PETSC_FALSE, PETSC_NULL_VEC, &
                      MatNullSpaceCreate
  use communicators, only: communicator_t
  use kinds, only: wp
  use models, only: model_t
  use numberings, only: numbering_t
  use petsc_matrices, only: petsc_matrix_t, put
  implicit none
  private
  public :: create_parts, describe_motions

contains

  !> Creates the matrix. Its subdomain on this rank has all equations of the rank's points, also those owned by other
  !> ranks.
  subroutine create_parts(communicator, numbering, matrix)
    type(communicator_t), intent(in) :: communicator
    type(numbering_t), intent(in) :: numbering
    !> The matrix, to be assembled like a global one
    type(petsc_matrix_t), intent(inout) :: matrix
    ! PETSc's handle of the map from equations of the subdomain to global ones
    integer(c_intptr_t) :: mapping
    integer, allocatable :: equations(:), widths(:)
    integer :: ierr

    widths = numbering%row_start(2:) - numbering%row_start(:numbering%rows)
    equations = pack(numbering%equation, numbering%equation >= 0)
    call ISLocalToGlobalMappingCreate(communicator%handle(), 1, size(equations), equations, PETSC_COPY_VALUES, &
                                      mapping, ierr)
    associate (rows => numbering%rows, total => numbering%total)
      call MatCreateIS(communicator%handle(), 1, rows, rows, total, total, mapping, mapping, matrix%object, ierr)
    end associate
    call MatISSetPreallocation(matrix%object, 0, widths, 0, 0*widths, ierr)
    call ISLocalToGlobalMappingDestroy(mapping, ierr)
  end subroutine create_parts

  !> Gives BDDC the equations of each component and the rigid motions of the plate. Without the components it finds no
  !> corners of subdomains, and these are unrestrained.
  subroutine describe_motions(communicator, model, numbering, matrix, preconditioner)
    type(communicator_t), intent(in) :: communicator
    type(model_t), intent(in) :: model
    type(numbering_t), intent(in) :: numbering
    type(petsc_matrix_t), intent(inout) :: matrix
    type(tPC), intent(inout) :: preconditioner
    type(tVec) :: motions(6)
    type(tMatNullSpace) :: null_space
    type(tIS) :: fields(5)
    integer, allocatable :: components(:)
    real(wp) :: product
    integer :: i, k, n, ierr

    do i = 1, size(motions)
      call MatCreateVecs(matrix%object, motions(i), PETSC_NULL_VEC, ierr)
      call put(motions(i), rigid_motion(model, numbering, i), ierr)
      do k = 1, i - 1
        call VecDot(motions(i), motions(k), product, ierr)
        call VecAXPY(motions(i), -product, motions(k), ierr)
      end do
      call VecNormalize(motions(i), product, ierr)
    end do
    call MatNullSpaceCreate(communicator%handle(), PETSC_FALSE, size(motions), motions, null_space, ierr)
    call MatSetNearNullSpace(matrix%object, null_space, ierr)
    call MatNullSpaceDestroy(null_space, ierr)
    components = pack(spread([1, 2, 3, 4, 5], 2, size(numbering%equation, 2)), numbering%equation >= 0)
    do i = 1, size(fields)
      associate (chosen => pack([(k, k=0, size(components) - 1)], components == i))
        n = size(chosen)
        call ISCreateGeneral(PETSC_COMM_SELF, n, chosen, PETSC_COPY_VALUES, fields(i), ierr)
      end associate
    end do
    call PCBDDCSetDofsSplittingLocal(preconditioner, size(fields), fields, ierr)
  end subroutine describe_motions

  !> A rigid motion in this rank's rows: three displacements, and rotations about the three axes. A material normal
  !> rotates with the surface, so that rotations are minus the slopes.
  function rigid_motion(model, numbering, number) result(rows)
    type(model_t), intent(in) :: model
    type(numbering_t), intent(in) :: numbering
    !> 1 to 6
    integer, intent(in) :: number
    !> The motion
    real(wp) :: rows(numbering%rows)
    real(wp) :: motion(5)
    integer :: row, point, component

    do row = 1, numbering%rows
      call numbering%place_of(numbering%first_row + row - 1, point, component)
      associate (place => model%plate%place_of(point))
        motion = 0
        select case (number)
        case (:3)
          motion(number) = 1
        case (4)
          motion(:2) = [-place(2), place(1)]
        case (5)
          motion(3:4) = [place(1), -1.0_wp]
        case default
          motion(3:5) = [place(2), 0.0_wp, -1.0_wp]
        end select
        rows(row) = motion(component)
      end associate
    end do
  end function rigid_motion
end module subdomain_matrices
