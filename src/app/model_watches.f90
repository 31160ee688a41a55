!> Watches over a run whether it passes the limits of the model, and tells so once, with the time at which it did.
module model_watches
  use archives, only: archive_t
  use deck_contents, only: deck_t
  use energy_watches, only: energy_watch_t
  use kinds, only: wp
  use mesh_parameters, only: edge_clamped
  use models, only: model_t
  use short_numbers, only: short_text
  use states, only: state_t
  use text, only: line_t, append, to_text
  implicit none
  private
  public :: model_watch_t

  !> What is watched for.
  integer, parameter :: border = 1, energy_made = 2, energy_taken = 3, indentation = 4, slopes = 5, stretched = 6
  !> How the end of a run names them.
  character(len=*), parameter :: names(6) = [character(len=60) :: &
    'a delamination at the border of its zone', 'energy created by the time integrators', &
    'energy taken by the time integrators', 'an indentation over the thickness', 'slopes beyond small rotations', &
    'a clamped plate with broken fibres, stretched far']
  !> Share of the impact's energy that integrators may take out.
  real(wp), parameter :: most_taken = 0.1_wp
  !> Rotation up to which its cosine counts as 1, as von Karman's strains take it: 2 % are lost there.
  real(wp), parameter :: steepest = 0.2_wp
  !> Deflection over thickness beyond which membrane forces carry a clamped plate.
  real(wp), parameter :: deepest = 3

  !> What was seen so far.
  type :: model_watch_t
    private
    !> Time at which each limit was passed; negative: it wasn't
    real(wp) :: since(size(names)) = -1
    !> Looks after the energy that integrators create
    type(energy_watch_t) :: energy
  contains
    !> Looks at an accepted step.
    procedure :: look
    !> What the end of a run tells.
    procedure :: closing
    !> Saves or loads what was seen.
    procedure :: visit
  end type model_watch_t

contains

  !> Looks at an accepted step; each limit is told once. Collective.
  subroutine look(self, deck, model, now, told)
    !> The watch
    class(model_watch_t), intent(inout) :: self
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The model
    type(model_t), intent(in) :: model
    !> The step reached
    type(state_t), intent(in) :: now
    !> What has to be told; empty: nothing new
    type(line_t), allocatable, intent(out) :: told(:)
    real(wp) :: amplitude, thickness

    allocate (told(0))
    thickness = deck%outlook%scales%thickness
    if (now%interfaces%border_reached) call note(border, 'A delamination has reached the border of its zone '// &
      'at time '//to_text(now%time)//' and cannot grow on there: if it would, make the zone larger.')
    if (now%indentation%alpha > thickness) call note(indentation, 'The indentation is deeper than the laminate is '// &
      'thick since time '//to_text(now%time)//': no contact law holds there; give a lighter blow or a blunter nose.')
    if (self%since(slopes) < 0) then
      if (is_steep(model, now)) call note(slopes, 'The plate is steeper than '//to_text(steepest)//' since time '// &
        to_text(now%time)//': its strains are those of small rotations, so distrust what follows.')
    end if
    if (self%since(stretched) < 0 .and. abs(now%deflection) > deepest*thickness) then
      if (is_torn(deck, model, now)) call note(stretched, 'The clamped plate deflects by more than '// &
        to_text(deepest)//' thicknesses with broken fibres since time '//to_text(now%time)// &
        ': membrane forces carry it, and the model tears no plies; distrust what follows.')
    end if
    if (deck%has_static) return
    amplitude = 1
    if (.not. deck%has_impactor) amplitude = deck%pressure%amplitude(now%time)
    if (self%energy%alarms(now%ledger, sum(now%interfaces%ties%deficit()), amplitude)) &
      call note(energy_made, 'The time integrators have created more than 1 % of the energy by time '// &
                to_text(now%time)//': take smaller steps, or more damping (rho_inf) with delamination.')
    if (now%ledger%algorithmic > most_taken*now%ledger%initial .and. now%ledger%initial > 0) &
      call note(energy_taken, 'The time integrators have taken more than '//short_text(100*most_taken)// &
                ' % of the impact''s energy by time '//to_text(now%time)//': take smaller steps, or less damping '// &
                '(rho_inf).')

  contains

    !> Tells a limit that is passed for the first time.
    subroutine note(limit, message)
      !> Which limit
      integer, intent(in) :: limit
      !> The sentence
      character(len=*), intent(in) :: message

      if (self%since(limit) >= 0) return
      self%since(limit) = now%time
      call append(told, message)
    end subroutine note
  end subroutine look

  !> True: somewhere the plate's section turns beyond small rotations. Collective.
  logical function is_steep(model, now)
    !> The model
    type(model_t), intent(in) :: model
    !> The step reached
    type(state_t), intent(in) :: now

    is_steep = model%communicator%any(maxval(abs(now%motion%displacement(4:5, :))) > steepest)
  end function is_steep

  !> True: a clamped plate has lost fibres. Collective.
  logical function is_torn(deck, model, now)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The model
    type(model_t), intent(in) :: model
    !> The step reached
    type(state_t), intent(in) :: now
    integer, parameter :: fibres = 1
    integer :: counts(3)

    is_torn = .false.
    if (.not. (deck%has_ply_damage .and. any(deck%plate%edges == edge_clamped))) return
    counts = now%plies%counts(model)
    is_torn = counts(fibres) > 0
  end function is_torn

  !> What the end of a run tells: limits passed and since when.
  pure subroutine closing(self, lines)
    !> The watch
    class(model_watch_t), intent(in) :: self
    !> One line a limit
    type(line_t), allocatable, intent(out) :: lines(:)
    integer :: i

    allocate (lines(0))
    do i = 1, size(names)
      if (self%since(i) < 0) cycle
      call append(lines, 'Beyond the model''s limits: '//trim(names(i))//' since time '//to_text(self%since(i))//'.')
    end do
  end subroutine closing

  !> Saves or loads what was seen.
  subroutine visit(self, archive)
    !> The watch
    class(model_watch_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    integer :: i

    do i = 1, size(names)
      call archive%item('limits/'//to_text(i), self%since(i))
    end do
  end subroutine visit
end module model_watches
