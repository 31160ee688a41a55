!> NAME_restart.h5: the state, bitwise exact, for any number of ranks. It is written to another file, sealed and
!> renamed, so that the file of that name is valid at any time.
module checkpoints
  use archives, only: archive_t
  use checkpoint_seal, only: head_length, seal, synchronise_folder, verify_seal
  use communicators, only: communicator_t
  use errors, only: error_t, exit_files, fail
  use field_mappings, only: field_mapping_t
  use files, only: file_exists, remove_file, rename_file
  use folder_listings, only: file_by_age
  use hdf5_data, only: read_integers, read_real_columns, read_reals, write_integers, write_real_columns, write_reals
  use hdf5_file, only: hdf5_file_t
  use hdf5_transfers, only: stored_shape
  use kinds, only: wp
  use run_provenance, only: provenance_t
  use stored_provenance, only: read_provenance, write_provenance
  implicit none
  private
  public :: checkpoint_archive_t, newest_checkpoint, retire_checkpoint

  !> Suffix of the names of checkpoints.
  character(len=*), parameter, public :: checkpoint_ending = '_restart.h5'
  !> Group of the items in the file.
  character(len=*), parameter :: items = 'state/'

  !> A checkpoint being saved or loaded.
  type, extends(archive_t) :: checkpoint_archive_t
    !> The run that wrote the file, after opening for loading
    type(provenance_t) :: provenance
    type(hdf5_file_t), private :: file
    !> Final path of the file
    character(len=:), allocatable, private :: path
  contains
    procedure :: open_for_saving
    procedure :: open_for_loading
    procedure :: close
    procedure :: real_item
    procedure :: integer_item
    procedure :: logical_item
    procedure :: reals_item
    procedure :: integers_item
    procedure :: table_item
    procedure :: field
  end type checkpoint_archive_t

contains

  !> Starts a checkpoint; the previous one is kept until this one is closed.
  subroutine open_for_saving(self, communicator, path, provenance, error)
    class(checkpoint_archive_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: path
    !> The run, deck included
    type(provenance_t), intent(in) :: provenance
    !> Raised if the file cannot be created
    type(error_t), allocatable, intent(inout) :: error

    self%loading = .false.
    self%path = path
    call self%file%create(communicator, aside(path), head_length)
    call write_provenance(self%file, 'provenance', provenance)
    if (allocated(self%file%failure)) call self%close(error)
  end subroutine open_for_saving

  !> Opens a checkpoint, after a check of its validity.
  subroutine open_for_loading(self, communicator, path, error)
    class(checkpoint_archive_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: path
    !> Raised if it cannot be read
    type(error_t), allocatable, intent(inout) :: error

    self%loading = .true.
    self%path = path
    if (communicator%is_root()) call verify_seal(path, error)
    call communicator%agree(error)
    if (allocated(error)) return
    call self%file%open(communicator, path, writable=.false.)
    call read_provenance(self%file, 'provenance', self%provenance)
    if (.not. allocated(self%file%failure)) return
    call fail(error, exit_files, "Cannot read the checkpoint "//path//': '//self%file%failure//'.')
    call self%file%close()
  end subroutine open_for_loading

  !> Ends saving or loading, and reports errors.
  subroutine close (self, error)
    class(checkpoint_archive_t), intent(inout) :: self
    !> Set if an item could not be saved or loaded; the previous checkpoint is then kept
    type(error_t), allocatable, intent(inout) :: error

    call self%file%close()
    if (allocated(self%file%failure)) then
      call fail(error, exit_files, "Cannot "//trim(merge('read ', 'write', self%loading))//' the checkpoint ' &
                //self%path//': '//self%file%failure//'.')
      if (.not. self%loading .and. self%file%communicator%is_root()) call remove_file(aside(self%path))
    else if (.not. self%loading) then
      if (self%file%communicator%is_root()) call put_in_place(self%path, error)
      call self%file%communicator%agree(error)
    end if
  end subroutine close

  !> Finds the newest valid checkpoint of a folder.
  subroutine newest_checkpoint(communicator, folder, path, error)
    type(communicator_t), intent(in) :: communicator
    !> Path of the folder
    character(len=*), intent(in) :: folder
    !> Path of the checkpoint
    character(len=:), allocatable, intent(out) :: path
    !> Raised if there is none
    type(error_t), allocatable, intent(inout) :: error
    type(error_t), allocatable :: fault
    character(len=:), allocatable :: name
    integer :: newer

    path = ''
    if (communicator%is_root()) then
      do newer = 0, huge(newer) - 1
        name = file_by_age(folder, checkpoint_ending, newer)
        if (name == '') exit
        path = folder//'/'//name
        if (allocated(fault)) deallocate (fault)
        call verify_seal(path, fault)
        if (.not. allocated(fault)) exit
        path = ''
      end do
      if (path == '') call fail(error, exit_files, 'The folder '//folder//' contains no complete checkpoint (NAME'// &
                                checkpoint_ending//').')
    end if
    call communicator%agree(error)
    call communicator%broadcast_text(path)
  end subroutine newest_checkpoint

  !> Renames the checkpoint of an earlier run, which must not be taken for that of the new run.
  subroutine retire_checkpoint(communicator, path, retired, error)
    type(communicator_t), intent(in) :: communicator
    !> Path of the checkpoint
    character(len=*), intent(in) :: path
    !> Its new path, replacing a file of that name; empty: there was no checkpoint
    character(len=:), allocatable, intent(out) :: retired
    !> Raised if it cannot be renamed
    type(error_t), allocatable, intent(inout) :: error

    retired = ''
    if (communicator%is_root()) then
      if (file_exists(path)) then
        retired = path//'.old'
        call rename_file(path, retired, error)
      end if
    end if
    call communicator%agree(error)
  end subroutine retire_checkpoint

  !> Seals the new file and gives it its name.
  subroutine put_in_place(path, error)
    !> Final path of the file
    character(len=*), intent(in) :: path
    !> Raised if one of these steps failed; a file that cannot have the name is removed
    type(error_t), allocatable, intent(inout) :: error

    call seal(aside(path), error)
    if (.not. allocated(error)) call rename_file(aside(path), path, error)
    if (allocated(error)) then
      call remove_file(aside(path))
      error%message = error%message(:len(error%message) - 1)//'; the new checkpoint has been removed.'
    else
      call synchronise_folder(folder(path), error)
    end if
  end subroutine put_in_place

  !> Path of the file until it is complete.
  pure function aside(path)
    !> Final path of the file
    character(len=*), intent(in) :: path
    !> Temporary path
    character(len=:), allocatable :: aside

    aside = path//'.tmp'
  end function aside

  !> Folder of a file.
  pure function folder(path)
    character(len=*), intent(in) :: path
    !> Its folder, with a slash at the end
    character(len=:), allocatable :: folder

    folder = './'
    if (index(path, '/') > 0) folder = path(:index(path, '/', back=.true.))
  end function folder

  !> Visits one real.
  subroutine real_item(self, name, value)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value
    real(wp), allocatable :: found(:)

    if (self%loading) then
      call read_reals(self%file, items//name, found, [integer ::])
      if (self%file%succeeded()) value = found(1)
    else
      call write_reals(self%file, items//name, [value], [integer ::])
    end if
  end subroutine real_item

  !> Visits one integer.
  subroutine integer_item(self, name, value)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    integer, allocatable :: found(:)

    if (self%loading) then
      call read_integers(self%file, items//name, found, [integer ::])
      if (self%file%succeeded()) value = found(1)
    else
      call write_integers(self%file, items//name, [value], [integer ::])
    end if
  end subroutine integer_item

  !> Visits one logical, stored as 0 or 1.
  subroutine logical_item(self, name, value)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    logical, intent(inout) :: value
    integer :: number

    number = merge(1, 0, value)
    call self%integer_item(name, number)
    value = number /= 0
  end subroutine logical_item

  !> Visits a list of reals.
  subroutine reals_item(self, name, value)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> The item; not allocated counts as length 0 when saving
    real(wp), allocatable, intent(inout) :: value(:)
    real(wp), allocatable :: found(:)

    if (self%loading) then
      call read_reals(self%file, items//name, found, extents_of(self, name, 1))
      if (self%file%succeeded()) call move_alloc(found, value)
    else if (allocated(value)) then
      call write_reals(self%file, items//name, value, shape(value))
    else
      call write_reals(self%file, items//name, [real(wp) ::], [0])
    end if
  end subroutine reals_item

  !> Visits a list of integers.
  subroutine integers_item(self, name, value)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> The item; not allocated counts as length 0 when saving
    integer, allocatable, intent(inout) :: value(:)
    integer, allocatable :: found(:)

    if (self%loading) then
      call read_integers(self%file, items//name, found, extents_of(self, name, 1))
      if (self%file%succeeded()) call move_alloc(found, value)
    else if (allocated(value)) then
      call write_integers(self%file, items//name, value, shape(value))
    else
      call write_integers(self%file, items//name, [integer ::], [0])
    end if
  end subroutine integers_item

  !> Visits a table of reals.
  subroutine table_item(self, name, value)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> The item; not allocated counts as 0 by 0 when saving
    real(wp), allocatable, intent(inout) :: value(:, :)
    real(wp), allocatable :: found(:)
    integer, allocatable :: extents(:)

    if (self%loading) then
      extents = extents_of(self, name, 2)
      call read_reals(self%file, items//name, found, extents)
      if (self%file%succeeded()) value = reshape(found, extents(1:2))
    else if (allocated(value)) then
      call write_reals(self%file, items//name, pack(value, .true.), shape(value))
    else
      call write_reals(self%file, items//name, [real(wp) ::], [0, 0])
    end if
  end subroutine table_item

  !> Visits a field distributed over the ranks, stored in global order.
  subroutine field(self, name, columns, global_columns, value, mapping)
    class(checkpoint_archive_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: columns(:)
    integer, intent(in) :: global_columns
    real(wp), intent(inout) :: value(:, :)
    !> A checkpoint has the mesh of its run
    type(field_mapping_t), intent(in) :: mapping

    if (self%loading) then
      call read_real_columns(self%file, items//name, columns, global_columns, value)
    else
      call write_real_columns(self%file, items//name, columns, global_columns, value)
    end if
  end subroutine field

  !> Extents of a stored list or table; zeros, which do not fit, if it has another rank or does not exist.
  function extents_of(self, name, rank) result(extents)
    class(checkpoint_archive_t), intent(in) :: self
    character(len=*), intent(in) :: name
    !> 1: a list, 2: a table
    integer, intent(in) :: rank
    integer, allocatable :: extents(:)
    integer :: i

    extents = stored_shape(self%file, items//name)
    if (size(extents) /= rank) extents = [(0, i=1, rank)]
  end function extents_of
end module checkpoints
