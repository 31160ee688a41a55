!> Sections with a response that depends on their strains within the equilibrium iteration, such as softening plies.
module section_laws
  use kinds, only: wp
  use element_batches, only: lanes
  implicit none
  private
  public :: section_law_t

  !> History variables of the element sections, and their response to trial strains. By default no element has common
  !> strains with others.
  type, abstract :: section_law_t
  contains
    procedure :: needs_joined_strains
    procedure :: accumulate_strains
    procedure :: exchange
    !> Stiffness of the sections of a batch under trial strains.
    procedure(soften_batch), deferred :: soften
  end type section_law_t

  abstract interface
    !> Stiffness of the sections of a batch under trial strains.
    subroutine soften_batch(self, b, weight, strains, stiffness, free)
      import :: section_law_t, wp, lanes
      !> The law; stores the trial state
      class(section_law_t), intent(inout) :: self
      integer, intent(in) :: b
      real(wp), intent(in) :: weight(lanes, 9)
      real(wp), intent(in) :: strains(lanes, 9, 6)
      !> Section stiffness: that of the last trial on entry, that of this one on return
      real(wp), intent(inout) :: stiffness(lanes, 21)
      !> Resultants of strains without stress and their energy, likewise; absent: there are none
      real(wp), intent(inout), optional :: free(lanes, 7)
    end subroutine soften_batch
  end interface

contains

  !> True for a batch with elements that soften by common strains, which must be known before any section softens.
  pure logical function needs_joined_strains(self, b)
    class(section_law_t), intent(in) :: self
    integer, intent(in) :: b

    needs_joined_strains = .false.
  end function needs_joined_strains

  !> Adds the trial strains of a batch to the common strains.
  subroutine accumulate_strains(self, b, weight, strains)
    class(section_law_t), intent(inout) :: self
    integer, intent(in) :: b
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
  end subroutine accumulate_strains

  !> Sends the common strains to all ranks. Collective.
  subroutine exchange(self)
    class(section_law_t), intent(inout) :: self
  end subroutine exchange
end module section_laws
