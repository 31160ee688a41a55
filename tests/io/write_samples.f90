!> Writes sample files for check_outputs.py, on any number of ranks: `write_samples fields|checkpoints FOLDER`. Fields:
!> a quarter plate of two layers, with values computed from the positions of the points, at times 0, 1 and 2; then a
!> restart from time 1 and a last output at 1.5. Checkpoints: one after the other, number n filled with n, until killed.
program write_samples
  use checkpoints, only: checkpoint_archive_t
  use communicators, only: communicator_t, finish_mpi, start_mpi
  use errors, only: error_t
  use field_datasets, only: global_numbers_t
  use fields_file, only: fields_file_t
  use kinds, only: wp
  use result_tables, only: result_row_length
  use run_provenance, only: this_run
  use sample_builds, only: sample_build
  implicit none

  !> Elements along x and y, and layers
  integer, parameter :: across = 6, along = 4, layers = 2
  !> Points along x and y
  integer, parameter :: points_across = 2*across + 1, points_along = 2*along + 1
  !> Table of the fields
  character(len=*), parameter :: rows(4) = [character(len=result_row_length) :: &
    'layer | cells | - | - | - | Number of the layer.', &
    'displacement | points | length | displacement | - | Displacement.', &
    'gap | points | length | gap | - | Product of x and y.', &
    'stress_N | cells | pressure | stress | - | Number of the element, growing with time.']
  !> Text in place of a deck
  character(len=*), parameter :: deck = "&case name='sample' /"//new_line('a')
  type(communicator_t) :: communicator
  type(error_t), allocatable :: error
  character(len=20) :: what
  character(len=500) :: folder

  call start_mpi(communicator)
  call get_command_argument(1, what)
  call get_command_argument(2, folder)
  if (what == 'fields') then
    call write_fields(trim(folder)//'/sample', error)
  else
    call write_checkpoints(trim(folder)//'/sample_restart.h5', error)
  end if
  if (allocated(error)) print '(a)', error%message
  call finish_mpi()

contains

  !> Writes the field files.
  subroutine write_fields(base, error)
    !> Folder and name
    character(len=*), intent(in) :: base
    !> Raised if they cannot be written
    type(error_t), allocatable, intent(inout) :: error
    type(fields_file_t) :: fields, again
    integer, allocatable :: points(:), cells(:)

    points = share_of(points_across*points_along*layers)
    cells = share_of(across*along*layers)
    call fields%describe(rows)
    call again%describe(rows)
    call fields%create(communicator, base, this_run(sample_build(), deck, communicator%size), 'quarter', error)
    call write_mesh(fields, points, cells, error)
    call write_time(fields, 0.0_wp, 0, points, cells, error)
    call write_time(fields, 1.0_wp, 1, points, cells, error)
    call write_time(fields, 2.0_wp, 2, points, cells, error)
    call again%resume(communicator, base, this_run(sample_build(), deck, communicator%size), 'quarter', 1.0_wp, error)
    call write_mesh(again, points, cells, error)
    call write_time(again, 1.5_wp, 2, points, cells, error)
  end subroutine write_fields

  !> This rank's share of numbered items, distributed cyclically with the last first.
  function share_of(number) result(mine)
    !> Number of items
    integer, intent(in) :: number
    !> Numbers of the rank's items
    integer, allocatable :: mine(:)
    integer :: i

    mine = pack([(i, i=number, 1, -1)], [(mod(i, communicator%size) == communicator%rank, i=number, 1, -1)])
  end function share_of

  !> Position of a point.
  pure function place(point)
    !> Its number
    integer, intent(in) :: point
    !> x, y, z
    real(wp) :: place(3)
    integer :: of_layer

    of_layer = mod(point - 1, points_across*points_along)
    place(1) = 0.5_wp*mod(of_layer, points_across)
    place(2) = 0.5_wp*(of_layer/points_across)
    place(3) = 0.25_wp*((point - 1)/(points_across*points_along))
  end function place

  !> Writes the mesh.
  subroutine write_mesh(fields, points, cells, error)
    !> The files
    type(fields_file_t), intent(inout) :: fields
    !> Points of this rank
    integer, intent(in) :: points(:)
    !> Elements of this rank
    integer, intent(in) :: cells(:)
    !> Raised if it cannot be written
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: coordinates(3, size(points))
    integer :: connectivity(9, size(cells)), layer(1, size(cells)), c, of_layer, first, i, j

    do i = 1, size(points)
      coordinates(:, i) = place(points(i))
    end do
    do c = 1, size(cells)
      layer(1, c) = 1 + (cells(c) - 1)/(across*along)
      of_layer = mod(cells(c) - 1, across*along)
      first = (layer(1, c) - 1)*points_across*points_along + 1 + 2*mod(of_layer, across) &
              + 2*(of_layer/across)*points_across
      connectivity(:, c) = [((first + i + points_across*j, i=0, 2), j=0, 2)]
    end do
    call fields%write_mesh(global_numbers_t(points, points_across*points_along*layers), &
                           global_numbers_t(cells, across*along*layers), coordinates, connectivity, ['layer'], layer, &
                           error)
  end subroutine write_mesh

  !> Writes one time.
  subroutine write_time(fields, time, step, points, cells, error)
    !> The files
    type(fields_file_t), intent(inout) :: fields
    !> The time
    real(wp), intent(in) :: time
    !> The step
    integer, intent(in) :: step
    !> Points of this rank
    integer, intent(in) :: points(:)
    !> Elements of this rank
    integer, intent(in) :: cells(:)
    !> Raised if it cannot be written
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: displacement(3, size(points)), gap(1, size(points)), stress(6, size(cells)), where(3)
    integer :: i

    do i = 1, size(points)
      where = place(points(i))
      displacement(:, i) = [where(1), 2*where(2), time + where(3)]
      gap(1, i) = where(1)*where(2)
    end do
    do i = 1, size(cells)
      stress(:, i) = cells(i) + time*[1, 2, 3, 4, 5, 6]
    end do
    call fields%begin(time, step, error)
    call fields%write_point_field('displacement', displacement, error)
    call fields%write_point_field('gap', gap, error)
    call fields%write_cell_field('stress', stress, error)
    call fields%finish(error)
  end subroutine write_time

  !> Writes checkpoints endlessly.
  subroutine write_checkpoints(path, error)
    !> Path of the file
    character(len=*), intent(in) :: path
    !> Raised if it cannot be written
    type(error_t), allocatable, intent(inout) :: error
    type(checkpoint_archive_t) :: archive
    real(wp), allocatable :: numbers(:)
    integer :: n

    allocate (numbers(50000))
    n = 0
    do while (.not. allocated(error))
      n = n + 1
      numbers = n
      call archive%open_for_saving(communicator, path, this_run(sample_build(), deck, communicator%size), error)
      call archive%item('n', n)
      call archive%item('numbers', numbers)
      call archive%close(error)
    end do
  end subroutine write_checkpoints
end program write_samples
