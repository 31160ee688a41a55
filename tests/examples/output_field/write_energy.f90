!> The field of a bent plate, compared with the strain energy of the full plate, written by the writer of the results
!> and read back: `write_energy DECK`.
program write_energy
  use communicators, only: communicator_t, start_mpi, finish_mpi
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_reader, only: read_deck
  use element_batches, only: batch_of, lane_of
  use energy_fields, only: strain_energy_density, write_energy_fields, energy_field_rows
  use errors, only: error_t
  use example_checks, only: require
  use field_results, only: write_mesh, field_rows
  use fields_file, only: fields_file_t
  use hdf5_data, only: read_real_columns
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use model_building, only: create_model
  use models, only: model_t
  use output_parameters, only: output_t
  use run_provenance, only: build_t, this_run
  implicit none
  type(communicator_t) :: communicator
  type(deck_t) :: deck
  type(problems_t) :: problems
  type(model_t) :: model
  type(error_t), allocatable :: error
  real(wp), allocatable :: bent(:, :), force(:, :), density(:, :), stiffness(:, :, :)
  real(wp) :: energy, x(2)
  character(len=500) :: path
  integer :: i

  call start_mpi(communicator)
  call get_command_argument(1, path)
  call read_deck(trim(path), deck, problems)
  call create_model(deck%setup, communicator, model, error)
  if (allocated(error)) stop 2
  allocate (bent(5, size(model%plate%distribution%points)), force(5, size(model%plate%distribution%points)), &
            source=0.0_wp)
  do i = 1, size(bent, 2)
    associate (node => model%plate%mesh%point_node(model%plate%distribution%points(i)))
      x = model%plate%mesh%node_coordinates(:, node)/deck%setup%plate%length
      bent(:, i) = [1e-5_wp*x(2), 2e-5_wp*x(1), 1e-3_wp*(1 - x(1)**2)*(1 - x(2)**2), 1e-2_wp*x(1), -1e-2_wp*x(2)]
    end associate
  end do
  ! A section with all couplings.
  stiffness = model%plate%elements%stiffness
  stiffness(:, [3, 5], :) = stiffness(:, [3, 5], :) + 0.1_wp*stiffness(:, [6, 6], :)
  stiffness(:, 7:12, :) = stiffness(:, 7:12, :) + 1e-4_wp*stiffness(:, 1:6, :)
  stiffness(:, [15, 17], :) = stiffness(:, [15, 17], :) + 0.1_wp*stiffness(:, [18, 18], :)
  stiffness(:, 20, :) = stiffness(:, 20, :) + 0.1_wp*stiffness(:, 21, :)
  density = strain_energy_density(model%plate, stiffness, bent)
  call model%internal(stiffness, bent, force, energy)
  call require('field times areas over strain energy', sum(density(1, :)*areas())/energy, 1.0_wp, 1e-13_wp)
  call write_and_read('example_output_field')
  call finish_mpi()

contains

  !> Area of each element.
  function areas()
    !> One an element
    real(wp) :: areas(size(density, 2))
    integer :: element

    do element = 1, size(areas)
      areas(element) = sum(model%plate%elements%weight(lane_of(element), :, batch_of(element)))
    end do
  end function areas

  !> Writes the field at one time, and reads it back.
  subroutine write_and_read(base)
    !> Name of the files, without suffix
    character(len=*), intent(in) :: base
    type(fields_file_t) :: fields
    type(hdf5_file_t) :: file
    type(build_t) :: build
    type(output_t) :: output
    real(wp) :: found(1, size(density, 2))
    integer :: unit

    build = build_t('example', 'none', 'none', 'none')
    output%fields = 'displacement,energy'
    call fields%describe([field_rows, energy_field_rows])
    call fields%create(communicator, base, this_run(build, deck%text, 1), 'whole', error)
    if (.not. allocated(error)) call write_mesh(model%plate, fields, error)
    call fields%begin(0.0_wp, 0, error)
    call write_energy_fields(model%plate, stiffness, bent, output, fields, error)
    call fields%finish(error)
    if (allocated(error)) stop 3
    found = 0
    call file%open(communicator, base//'.h5', writable=.false.)
    call read_real_columns(file, 'times/00000001/cells/strain_energy_density', model%plate%distribution%elements, &
                           model%plate%mesh%elements(), found)
    call file%close()
    call require('largest difference of what the file holds', maxval(abs(found - density)), 0.0_wp, 0.0_wp)
    open (newunit=unit, file=base//'.h5')
    close (unit, status='delete')
    open (newunit=unit, file=base//'.xdmf')
    close (unit, status='delete')
  end subroutine write_and_read
end program write_energy
