!> How a field of points or elements is mapped to another mesh: its owner says so where it saves and loads the field.
module field_mappings
  use kinds, only: wp
  implicit none
  private
  public :: area_field, field_mapping_t, motion_field, ply_field, ply_shear_field, vector_field, vector_fields

  !> Most vectors of a field: displacements and rotations of lines in explicit steps, of reactions, changes and
  !> offsets each.
  integer, parameter :: max_vectors = 6

  !> Properties of a field that its mapping needs.
  type :: field_mapping_t
    !> True: the five unknowns of points, which are interpolated; false: the field is averaged over areas
    logical :: is_motion = .false.
    !> True: each ply of the plate has the same number of rows
    logical :: is_per_ply = .false.
    !> Row of the component along x of each vector, whose component along y is the next row; 0: none
    integer :: vectors(max_vectors) = 0
    !> Row of a shear strain; 0: none
    integer :: shear = 0
  contains
    procedure :: signs
  end type field_mapping_t

  !> Scalars per area or volume; those of each ply; a shear strain of each ply, followed by a scalar; a vector in the
  !> first two rows; the five unknowns of points, in which u and v, and the two rotations, are vectors.
  type(field_mapping_t), parameter :: area_field = field_mapping_t(), &
                                      ply_field = field_mapping_t(is_per_ply=.true.), &
                                      ply_shear_field = field_mapping_t(is_per_ply=.true., shear=1), &
                                      vector_field = field_mapping_t(vectors=[1, 0, 0, 0, 0, 0]), &
                                      motion_field = field_mapping_t(is_motion=.true., vectors=[1, 4, 0, 0, 0, 0])

contains

  !> A field with several vectors.
  pure type(field_mapping_t) function vector_fields(rows)
    !> Row of the component along x of each
    integer, intent(in) :: rows(:)

    vector_fields%vectors(:size(rows)) = rows
  end function vector_fields

  !> Factors of the rows of a column, or of the rows of one of its plies, that is taken from an image: components along
  !> a reversed axis change their sign, shear strains under one reversed axis of the two.
  pure function signs(self, rows, turned)
    class(field_mapping_t), intent(in) :: self
    !> Number of rows
    integer, intent(in) :: rows
    !> True: the image has x, or y, reversed
    logical, intent(in) :: turned(2)
    !> 1 or -1
    real(wp) :: signs(rows)
    integer :: i

    signs = 1
    do i = 1, count(self%vectors > 0)
      associate (row => self%vectors(i))
        where (turned) signs(row:row + 1) = -1
      end associate
    end do
    if (self%shear > 0 .and. (turned(1) .neqv. turned(2))) signs(self%shear) = -1
  end function signs
end module field_mappings
