!> Scales of a setup that its mesh and steps have to resolve, from its parameters alone.
module setup_scales
  use curved_modes, only: shallow_shape_t
  use delamination_parameters, only: toughnesses
  use interface_strengths, only: interlaminar_strengths
  use interlaminar_stresses, only: unit_stresses_t, unit_stresses_of
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use mathematical_constants, only: pi
  use mesh_parameters, only: curvatures, edge_elastic, edge_free, edge_simple, in_plane_fixed
  use modal_plates, only: modal_plate_t, modal_plate_of
  use plies, only: ply_t
  use ply_stacks, only: ply_stack_t
  use setups, only: setup_t
  use mean_stiffnesses, only: in_bending
  use stacking, only: section_t, stacked_plies, section_of
  use stiffened_sections, only: bays_of, free_bending, is_stiffened, plate_part_t, section_of_part, whole_part
  use support_parameters, only: window_none, window_rectangle, window_circle
  use threshold_forces, only: effective_bending_stiffness, threshold_force
  implicit none
  private
  public :: setup_scales_t, scales_of, plate_modes, contact_side, free_span, free_edges, bending_section, &
            growth_thresholds, loaded_side

  !> Scales of a setup. It has many components because each is one line of the table that users read.
  type :: setup_scales_t
    !> Thickness and mass per area of the laminate
    real(wp) :: thickness = 0, area_mass = 0
    !> Mean bending stiffness of the section, (D11 + D22)/2
    real(wp) :: bending = 0
    !> Mass of the full plate
    real(wp) :: plate_mass = 0
    !> Period of the plate's first bending mode, without rigid-body motion
    real(wp) :: first_period = 0
    !> Energy of the impactor
    real(wp) :: energy = 0
    !> Rise time of the force of first contact
    real(wp) :: contact_time = 0
    !> Length of the bending waves excited by first contact
    real(wp) :: wave_length = 0
    !> Central deflection per force, static
    real(wp) :: compliance = 0
    !> Delamination threshold force (closed form); 0: no interface may delaminate
    real(wp) :: threshold = 0
    !> Force at interlaminar shear failure beside the contact; 0: no strength or no patch is known
    real(wp) :: onset = 0
  end type setup_scales_t

  !> Duration of Hertz' contact of two bodies that move freely, 2.943 alpha_max/v (W. Goldsmith, Impact, 1960).
  real(wp), parameter :: hertz_duration = 2.943_wp
  !> A frequency above all modes with a finite square.
  real(wp), parameter :: all_modes = 1.0e100_wp

contains

  !> The scales. A setup without impactor has only those of its plate.
  pure function scales_of(setup) result(scales)
    !> The setup, checked
    type(setup_t), intent(in) :: setup
    type(setup_scales_t) :: scales
    type(section_t) :: section
    type(laminate_t) :: local
    type(modal_plate_t) :: plate
    real(wp) :: bent

    section = bending_section(setup)
    local = setup%struck_laminate()
    scales%thickness = sum(local%thickness)
    scales%area_mass = section%mass(1)
    scales%bending = (section%stiffness(13) + section%stiffness(16))/2
    scales%plate_mass = section%mass(1)*product(setup%plate%length)
    plate = modal_plate_of(free_span(setup), free_edges(setup), section%stiffness, [1.0_wp, 0.0_wp, 0.0_wp], &
                           loaded_side(setup), all_modes, shape_of(setup), setup%mesh%struck)
    bent = first_frequency(plate)
    if (section%mass(1) > 0) scales%first_period = 2*pi*sqrt(section%mass(1))/bent
    if (is_stiffened(setup) .and. section%mass(1) > 0) scales%first_period = stiffened_period(setup)
    scales%compliance = sum(plate%weight/plate%frequency**2, mask=plate%frequency >= bent)
    if (allocated(setup%delaminations)) then
      if (size(setup%delaminations) > 0) scales%threshold = minval(growth_thresholds(setup))
    end if
    scales%onset = onset_force(setup)
    if (.not. setup%is_impact()) return
    associate (m => setup%impactor%mass, v => setup%impactor%velocity, k => setup%impactor%indentation%k)
      scales%energy = m*v**2/2
      ! The plate responds to waves like a dashpot of 8 sqrt(D rho h) (Boussinesq; Olsson 1992).
      scales%contact_time = min((8*sqrt(scales%bending*scales%area_mass)*v/k)**(2.0_wp/3)/v, &
                                hertz_duration/2*(1.25_wp*m*v**2/k)**0.4_wp/v)
      scales%wave_length = 2*pi*(scales%bending/scales%area_mass)**0.25_wp*sqrt(scales%contact_time/pi)
    end associate
  end function scales_of

  !> First frequency of bending.
  pure real(wp) function first_frequency(plate) result(bent)
    type(modal_plate_t), intent(in) :: plate

    bent = minval(plate%frequency, mask=plate%frequency > 1.0e-6_wp*maxval(plate%frequency))
  end function first_frequency

  !> Period of the first bending mode of a plate with stringers, doublers or ply drops: the longest one of the entire
  !> plate and of the bays between its stringers.
  pure real(wp) function stiffened_period(setup) result(period)
    type(setup_t), intent(in) :: setup
    type(plate_part_t) :: whole
    type(plate_part_t), allocatable :: bays(:)
    integer :: i

    whole = whole_part(free_span(setup), free_edges(setup))
    bays = bays_of(setup, whole)
    period = period_of(whole, .true.)
    do i = 1, size(bays)
      period = max(period, period_of(bays(i), .false.))
    end do

  contains

    !> Period of a part of the plate.
    pure real(wp) function period_of(part, with_stringers) result(of_part)
      !> The plate, or one of its bays
      type(plate_part_t), intent(in) :: part
      !> False: without its stringers
      logical, intent(in) :: with_stringers
      type(section_t) :: section
      type(modal_plate_t) :: plate

      section = section_of_part(setup, part, with_stringers)
      plate = modal_plate_of(part%length(), part%edges, section%stiffness, section%mass, minval(part%length()), &
                             all_modes, shape_of(setup))
      of_part = 2*pi/first_frequency(plate)
    end function period_of
  end function stiffened_period

  !> Bending section of the plate: mean over its area where it has doublers or ply drops.
  pure function bending_section(setup) result(section)
    type(setup_t), intent(in) :: setup
    !> Stiffness and mass
    type(section_t) :: section
    type(section_t) :: part
    logical, allocatable :: known(:, :)
    real(wp), allocatable :: shares(:)
    integer :: i

    if (setup%zones%is_empty()) then
      section = section_of_laminate(setup, setup%laminate)
      return
    end if
    call setup%zones%find_shares(setup%plate%length, known, shares)
    do i = 1, size(shares)
      if (.not. shares(i) > 0) cycle
      part = section_of_laminate(setup, setup%zones%laminate_of(setup%laminate, known(:, i)))
      section%stiffness = section%stiffness + shares(i)*part%stiffness
      section%mass = section%mass + shares(i)*part%mass
    end do
  end function bending_section

  !> Bending section of a laminate whose membrane strains are free: D - B inverse(A) B (Reissner and Stavsky).
  pure function section_of_laminate(setup, laminate) result(section)
    type(setup_t), intent(in) :: setup
    type(laminate_t), intent(in) :: laminate
    !> Stiffness and mass
    type(section_t) :: section

    section = section_of(in_bending(stacked_plies(laminate, setup%materials)), laminate%shear_correction)
    section%stiffness(13:18) = free_bending(section%stiffness)
  end function section_of_laminate

  !> Modes of the setup's plate up to a frequency.
  pure function plate_modes(setup, cutoff, scaling) result(plate)
    type(setup_t), intent(in) :: setup
    !> Circular frequency
    real(wp), intent(in) :: cutoff
    !> Factor of rotary and in-plane inertia, 1 if absent
    real(wp), intent(in), optional :: scaling
    type(modal_plate_t) :: plate
    type(section_t) :: section
    type(shallow_shape_t) :: shape

    section = bending_section(setup)
    shape = shape_of(setup)
    if (present(scaling)) section%mass(3) = scaling*section%mass(3)
    if (present(scaling)) shape%scaling = scaling
    plate = modal_plate_of(free_span(setup), free_edges(setup), section%stiffness, section%mass, &
                           loaded_side(setup), cutoff, shape, setup%mesh%struck)
  end function plate_modes

  !> Curvature of the plate, and the lines that its edges hold at both ends. Frames hold no in-plane displacement.
  !> An imperfection is not counted.
  pure function shape_of(setup) result(shape)
    type(setup_t), intent(in) :: setup
    type(shallow_shape_t) :: shape

    shape%curvature = curvatures(setup%plate)
    shape%is_held = setup%plate%in_plane == in_plane_fixed .and. &
                    [all(setup%plate%edges(1:2) /= edge_free), all(setup%plate%edges(3:4) /= edge_free)]
  end function shape_of

  !> Lengths of the free span of the plate: the full plate, or the window of its frame. A circular window is replaced by
  !> the square with the same first frequency, both simply supported: 4.977/(radius)**2 for nu = .3 (A. W. Leissa,
  !> Vibration of Plates, NASA SP-160, 1969, table 2.4) and 2 pi**2/side**2.
  pure function free_span(setup) result(length)
    type(setup_t), intent(in) :: setup
    !> Along x and y
    real(wp) :: length(2)
    integer :: i

    length = setup%plate%length
    if (.not. allocated(setup%supports)) return
    do i = 1, size(setup%supports)
      associate (support => setup%supports(i))
        if (support%shape == window_rectangle) length = min(length, support%window)
        if (support%shape == window_circle) length = min(length, sqrt(2/4.977_wp)*pi*support%radius)
      end associate
    end do
  end function free_span

  !> Supports of its edges: a frame is a simple support.
  pure function free_edges(setup) result(edges)
    type(setup_t), intent(in) :: setup
    !> In the order of the deck
    integer :: edges(4)

    edges = setup%plate%edges
    where (edges == edge_elastic) edges = edge_simple
    if (.not. allocated(setup%supports)) return
    if (any(setup%supports%shape /= window_none)) edges = edge_simple
  end function free_edges

  !> Side of the loaded square; without a patch in the deck, as small as plate theory can resolve.
  pure real(wp) function loaded_side(setup) result(side)
    type(setup_t), intent(in) :: setup
    type(laminate_t) :: local

    local = setup%struck_laminate()
    side = setup%mesh%patch
    if (.not. side > 0) side = min(sum(local%thickness), minval(setup%plate%length))
  end function loaded_side

  !> Side of the square in the mid-plane that carries the contact force. Its area is that of Hertz's contact circle,
  !> widened at 45 degrees from the struck face to the mid-plane. Deformation below the scale of the thickness is part
  !> of the indentation law.
  pure real(wp) function contact_side(setup, indentation) result(side)
    type(setup_t), intent(in) :: setup
    !> Largest indentation
    real(wp), intent(in) :: indentation
    real(wp) :: radius
    type(laminate_t) :: local

    local = setup%struck_laminate()
    radius = setup%contact_radius()
    ! If the radius is not given: the radius of a rigid sphere for which Sun's formula gives this k.
    if (.not. radius > 0) &
      radius = (0.75_wp*setup%impactor%indentation%k/setup%materials(local%material(1))%e2)**2
    side = sqrt(pi*radius*indentation) + sum(local%thickness)
  end function contact_side

  !> Delamination threshold forces with the toughness of each interface: equal circular delaminations of all interfaces
  !> at the struck point, where bonds of doublers elsewhere do not lie.
  pure function growth_thresholds(setup) result(forces)
    type(setup_t), intent(in) :: setup
    real(wp) :: forces(size(setup%delaminations))
    type(section_t) :: section
    type(ply_stack_t) :: stack
    real(wp) :: toughness(2)
    integer :: i, k, interfaces

    section = section_of_laminate(setup, setup%struck_laminate())
    stack = setup%struck_stack()
    interfaces = size(forces)
    do i = 1, size(forces)
      if (.not. setup%delaminations(i)%bonds_doublers()) cycle
      if (.not. any([(stack%has(setup%delaminations(i)%beside(k)), k=1, size(setup%delaminations(i)%beside))])) &
        interfaces = interfaces - 1
    end do
    do i = 1, size(forces)
      toughness = toughnesses(setup%delaminations(i))
      forces(i) = threshold_force(effective_bending_stiffness(section%stiffness), toughness(2), max(1, interfaces))
    end do
  end function growth_thresholds

  !> Force at which interlaminar stresses reach the strength next to the loaded patch. The shear force is distributed
  !> uniformly over the four sides of the patch, and decreases outside as around a circle of this circumference.
  pure real(wp) function onset_force(setup) result(force)
    type(setup_t), intent(in) :: setup
    type(ply_t), allocatable :: plies(:)
    type(ply_stack_t) :: stack
    type(unit_stresses_t) :: unit
    real(wp) :: decrease, index

    force = 0
    plies = in_bending(stacked_plies(setup%struck_laminate(), setup%materials))
    if (size(plies) < 2 .or. .not. setup%mesh%patch > 0) return
    stack = setup%struck_stack()
    unit = unit_stresses_of(plies)
    ! Q = P/(2 pi r): its derivative is -Q/r along the radius, and +Q/r for the component normal to it.
    decrease = pi/(2*setup%mesh%patch)
    associate (strengths => interlaminar_strengths(plies, stack%number, setup%materials, &
                                                      setup%delaminations), &
               gradient => reshape([-decrease, 0.0_wp, 0.0_wp, decrease], [2, 2]))
      index = max(maxval(unit%onset_indices(strengths, [1.0_wp, 0.0_wp], gradient)), &
                  maxval(unit%onset_indices(strengths, [0.0_wp, 1.0_wp], -gradient)))
    end associate
    if (index > 0) force = 4*setup%mesh%patch/index
  end function onset_force
end module setup_scales
