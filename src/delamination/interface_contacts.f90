!> Contact over one interface: the multipliers of its nodes, which outlive a time step.
module interface_contacts
  use archives, only: archive_t
  use face_contact, only: contact_law_t, contact_residual, updated_multiplier
  use kinds, only: wp
  implicit none
  private
  public :: interface_contact_t, tie_pressure

  !> Multipliers of the nodes of one interface that this rank looks after.
  type :: interface_contact_t
    !> Estimates of the contact pressure, zero where the faces are tied; stays on the nodes' order of the caller
    real(wp), allocatable :: multiplier(:)
  contains
    !> Takes the pressures found as the next multipliers.
    procedure :: update
    !> Largest violation of complementarity and largest penetration, both as lengths.
    procedure :: largest_violation
    !> Saves or loads.
    procedure :: visit
  end type interface_contact_t

contains

  !> Multiplier of a node that has just come apart: the pressure that its tie has carried.
  elemental real(wp) function tie_pressure(tie_force, area) result(pressure)
    !> Normal force that held the jump at zero, positive where it held back an opening
    real(wp), intent(in) :: tie_force
    !> Area of the node
    real(wp), intent(in) :: area
    pressure = max(0.0_wp, -tie_force/area)
  end function tie_pressure

  !> Takes the pressures found as the next multipliers.
  pure subroutine update(self, law, gaps, apart)
    !> The contact
    class(interface_contact_t), intent(inout) :: self
    !> The law
    type(contact_law_t), intent(in) :: law
    !> Gaps of the nodes, positive when open
    real(wp), intent(in) :: gaps(:)
    !> True where the faces have come apart; the other nodes have no contact
    logical, intent(in) :: apart(:)

    where (apart)
      self%multiplier = updated_multiplier(law, gaps, self%multiplier)
    elsewhere
      self%multiplier = 0
    end where
  end subroutine update

  !> How far nodes in balance with their multipliers are from contact without penetration.
  pure subroutine largest_violation(self, law, gaps, apart, violation, penetration)
    !> The contact
    class(interface_contact_t), intent(in) :: self
    !> The law
    type(contact_law_t), intent(in) :: law
    !> Gaps of the nodes, positive when open
    real(wp), intent(in) :: gaps(:)
    !> True where the faces have come apart
    logical, intent(in) :: apart(:)
    !> Largest violation of complementarity, as a length
    real(wp), intent(out) :: violation
    !> Largest penetration
    real(wp), intent(out) :: penetration
    integer :: node

    violation = 0
    penetration = 0
    do node = 1, size(gaps)
      if (.not. apart(node)) cycle
      violation = max(violation, abs(contact_residual(law, gaps(node), self%multiplier(node))))
      penetration = max(penetration, -gaps(node))
    end do
  end subroutine largest_violation

  !> Saves or loads the multipliers, a field over the nodes that is spread over the ranks.
  subroutine visit(self, archive, name, columns, global_columns)
    !> The contact, its multipliers allocated
    class(interface_contact_t), intent(inout) :: self
    !> Where to or from
    class(archive_t), intent(inout) :: archive
    !> Name of the contact within the archive
    character(len=*), intent(in) :: name
    !> Global numbers of the leading nodes, which this rank owns
    integer, intent(in) :: columns(:)
    !> Number of nodes of all ranks
    integer, intent(in) :: global_columns
    real(wp), allocatable :: field(:, :)

    field = reshape(self%multiplier, [1, size(self%multiplier)])
    call archive%field(name//'/contact_pressure', columns, global_columns, field)
    self%multiplier = field(1, :)
  end subroutine visit
end module interface_contacts
