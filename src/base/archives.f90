!> Each type with evolving data has one routine that both saves and loads it, so that checkpoint, repetition of a step
!> and restart have the same state.
module archives
  use field_mappings, only: field_mapping_t
  use kinds, only: wp
  implicit none
  private
  public :: archive_t

  !> Storage of named items, saved or loaded in the order in which they are visited. Errors are stored, and checked at
  !> the end by the owner of the archive.
  type, abstract :: archive_t
    !> True: items are read into the variables visited; false: variables are written out.
    logical :: loading = .false.
  contains
    !> Visits a value that is the same on every rank.
    generic :: item => real_item, integer_item, logical_item, reals_item, integers_item, table_item
    procedure(visit_real), deferred :: real_item
    procedure(visit_integer), deferred :: integer_item
    procedure(visit_logical), deferred :: logical_item
    procedure(visit_reals), deferred :: reals_item
    procedure(visit_integers), deferred :: integers_item
    procedure(visit_table), deferred :: table_item
    !> Visits a field spread over the ranks.
    procedure(visit_field), deferred :: field
  end type archive_t

  abstract interface
    !> Visits one real.
    subroutine visit_real(self, name, value)
      import :: archive_t, wp
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive (a path such as `impactor/velocity`)
      character(len=*), intent(in) :: name
      !> The item
      real(wp), intent(inout) :: value
    end subroutine visit_real

    !> Visits one integer.
    subroutine visit_integer(self, name, value)
      import :: archive_t
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive
      character(len=*), intent(in) :: name
      !> The item
      integer, intent(inout) :: value
    end subroutine visit_integer

    !> Visits one logical.
    subroutine visit_logical(self, name, value)
      import :: archive_t
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive
      character(len=*), intent(in) :: name
      !> The item
      logical, intent(inout) :: value
    end subroutine visit_logical

    !> Visits a list of reals, which is allocated to its stored length when loading.
    subroutine visit_reals(self, name, value)
      import :: archive_t, wp
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive
      character(len=*), intent(in) :: name
      !> The item
      real(wp), allocatable, intent(inout) :: value(:)
    end subroutine visit_reals

    !> Visits a list of integers, which is allocated to its stored length when loading.
    subroutine visit_integers(self, name, value)
      import :: archive_t
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive
      character(len=*), intent(in) :: name
      !> The item
      integer, allocatable, intent(inout) :: value(:)
    end subroutine visit_integers

    !> Visits a table of reals, which is allocated to its stored shape when loading.
    subroutine visit_table(self, name, value)
      import :: archive_t, wp
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive
      character(len=*), intent(in) :: name
      !> The item
      real(wp), allocatable, intent(inout) :: value(:, :)
    end subroutine visit_table

    !> Visits a field: column i of this rank belongs to the global column `columns(i)`, which only
    !> one rank owns. Stored in global order, so a file can be read by another number of ranks.
    subroutine visit_field(self, name, columns, global_columns, value, mapping)
      import :: archive_t, field_mapping_t, wp
      class(archive_t), intent(inout) :: self
      !> Name, unique within the archive
      character(len=*), intent(in) :: name
      !> Global columns (1-based) of the leading columns of `value`, which this rank owns
      integer, intent(in) :: columns(:)
      !> Number of columns of the global field
      integer, intent(in) :: global_columns
      !> The field; columns after `size(columns)` (ghosts) are not changed
      real(wp), intent(inout) :: value(:, :)
      !> How it is mapped to another mesh
      type(field_mapping_t), intent(in) :: mapping
    end subroutine visit_field
  end interface
end module archives
