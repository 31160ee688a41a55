!> Steps below a spherical nose before there is a model, theory (T6): the contact limits the step where the laminate has
!> thin layers and short cells.
module nose_steps
  use communicators, only: communicator_t
  use deck_contents, only: deck_t
  use element_steps, only: small_setup
  use errors, only: error_t
  use impactor_steps, only: impactor_steps_t
  use inertia_scaling, only: create_inertia_scaling, inertia_scaling_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use model_building, only: create_model
  use models, only: model_t
  use nodal_inertia, only: create_nodal_inertia, nodal_inertia_t
  use ply_failures, only: new_ply_failure
  use section_bounds, only: largest_stiffness
  use setups, only: setup_t
  use stable_steps, only: find_sprung_elements, sprung_elements_t
  use struck_patches, only: create_struck_patch
  use tan_sun_indentation, only: commit_indentation, indentation_of, indentation_t
  implicit none
  private
  public :: steps_below_nose

  !> Positions of the nose in a contact whose force is half a sine. Four times as many, and two and a half times as many
  !> elements, change the steps of three panels by .5 % at most.
  integer, parameter :: positions = 40
  !> Largest number of elements along a side below the nose, which bounds the time of the check.
  integer, parameter :: max_cells = 16

contains

  !> Mean number of steps in a contact, over that without it; 1 where no nose presses point by point.
  real(wp) function steps_below_nose(deck) result(ratio)
    !> The deck, its mesh checked and its expected results known
    type(deck_t), intent(in) :: deck
    type(setup_t) :: setup
    type(model_t) :: model
    type(communicator_t) :: alone
    type(error_t), allocatable :: error
    real(wp) :: radius

    ratio = 1
    if (.not. (deck%setup%impactor%spreads .and. deck%expected%of_impact)) return
    setup = small_setup(deck, 2, deck%setup%zones%at(deck%setup%mesh%struck))
    radius = sqrt(deck%setup%contact_radius()*deck%expected%indentation)
    setup%mesh%elements = min(max_cells, 2*ceiling(radius/minval(setup%plate%length/2)) + 2)
    setup%plate%length = setup%plate%length/2*setup%mesh%elements
    setup%impactor = deck%setup%impactor
    call create_model(setup, alone, model, error)
    if (allocated(error)) return
    ratio = mean_ratio(deck, model)
  end function steps_below_nose

  !> The mean over a contact, of the struck part as a model of its own.
  real(wp) function mean_ratio(deck, model) result(ratio)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    type(inertia_scaling_t) :: scaling
    type(nodal_inertia_t) :: inertia
    type(sprung_elements_t) :: sprung
    type(impactor_steps_t) :: impact
    type(indentation_t) :: indentation
    real(wp), allocatable :: w(:)
    real(wp) :: position, alpha
    integer :: i

    scaling = create_inertia_scaling(deck%setup, deck%stepping%central%mass_scaling)
    inertia = create_nodal_inertia(model, scaling)
    call inertia%invert(0.0_wp)
    impact%patch = create_struck_patch(model)
    impact%patch%inverse = impact%patch%points%gathered(model%plate%communicator, inertia%inverse_of_images())
    call find_sprung_elements(model%plate, largest_stiffness(new_ply_failure(model%plate)), scaling, &
                              impact%patch%points%local, sprung)
    allocate (w(size(impact%patch%weights)), source=0.0_wp)
    ratio = 0
    do i = 1, positions
      position = indentation_of(model%plate%setup%impactor%indentation, indentation, &
                                deck%expected%force*sin(pi*(i - 0.5_wp)/positions))
      call impact%patch%find_indentation(w, position, alpha)
      call commit_indentation(model%plate%setup%impactor%indentation, indentation, alpha)
      ratio = ratio + sqrt(sprung%bound(impact%allowed_square(model%plate, indentation))/sprung%squares(1)) &
                      /positions
    end do
  end function mean_ratio
end module nose_steps
