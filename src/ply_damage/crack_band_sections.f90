!> Softening plies in every element: one state per ply and element, which depends on the mean squares of the strains
!> over the ply's volume in the element. Elements beside the lines through the struck point share their damage. Energy
!> and force then derive from one potential, and the energy lost by damage is that of the law, for any strains within
!> the element.
module crack_band_sections
  use archives, only: archive_t
  use band_energies, only: resultants_without_strain
  use band_states, only: band_states_t, new_band_states
  use crack_bands, only: band_state_t, band_strains_t, crack_band_t, soften_band, &
                         degraded_elasticity, is_damaged, stiffness_lost, tensile_stress
  use crack_band_limits, only: may_soften, onset_strain
  use drawn_strengths, only: drawn_strengths_t, new_drawn_strengths
  use element_batches, only: batch_of, first_element, lane_of, lanes
  use joined_elements, only: joined_elements_t, find_elastic_strains, find_joined_elements
  use kinds, only: wp
  use laminate_laws, only: find_laws
  use loaded_plies, only: loaded_plies_t, new_loaded_plies
  use loading_rates, only: loading_rates_t, new_loading_rates
  use mean_sections, only: mean_sections_t, new_mean_sections
  use composite_plates, only: composite_plate_t
  use plies, only: ply_t, elasticity_t
  use ply_damage_parameters, only: energy_modes, matrix_tension, matrix_compression
  use ply_strains, only: invariant_measure, moment_values, moments_from, strain_moments_t
  use section_laws, only: section_law_t
  use signed_sections, only: signed_resultants
  use stacking, only: in_plane_section
  use strain_bounds, only: strain_moments, strain_sizes
  use stressed_volumes, only: stressed_volumes_t, new_stressed_volumes
  implicit none
  private
  public :: crack_band_sections_t, new_crack_band_sections

  !> The plies of this rank's elements, with a component for each effect because a deck may leave it out.
  type, extends(section_law_t) :: crack_band_sections_t
    !> Damage and energies of the plies
    type(band_states_t) :: states
    !> Section stiffness in the trial, (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Resultants of stress-free strains in the trial, (lanes, 7, batches); unallocated: there are none
    real(wp), allocatable :: free(:, :, :)
    !> Sections against mean strains, where plies have E1c; unallocated: they have not
    type(mean_sections_t), allocatable :: signs
    !> Stressed volumes that the strengths of fibres depend on; unallocated: they do not
    type(stressed_volumes_t), allocatable :: volumes
    !> Strengths of fibres that scatter from place to place; unallocated: they do not
    type(drawn_strengths_t), allocatable :: drawn
    !> Strain rates that the strengths of the matrix depend on; unallocated: they do not
    type(loading_rates_t), allocatable :: rates
    !> True while plies keep their damage, during the transfer of a state to other layers
    logical :: keeps_damage = .false.
    !> Resultants of stress-free strains with the moduli in tension, where plies have E1c, (lanes, 7, batches)
    real(wp), allocatable, private :: tensile(:, :, :)
    !> Plies of the different laminates, one after the other
    type(ply_t), allocatable :: plies(:)
    !> Their laws
    type(crack_band_t), allocatable :: bands(:)
    !> Sides along x and y of each element with those that share its state, (2, elements)
    real(wp), allocatable :: sides(:, :)
    !> Area of each element, (elements)
    real(wp), allocatable :: area(:)
    !> Elements that share their state with others
    type(joined_elements_t) :: joined
    !> Strain below which damage does not start in each ply, and distance of its outer face from the middle surface
    real(wp), allocatable, private :: onset(:), height(:)
    !> The smallest onset and the largest distance of each element's plies, (lanes, 2, batches)
    real(wp), allocatable, private :: limits(:, :, :)
    !> True: strengths of a ply are not those of its law everywhere and at all times
    logical, private :: strengths_vary = .false.
    !> True for elements with damage in the trial, (elements)
    logical, allocatable :: touched(:)
    !> True for elements whose trial may differ from the accepted state, (elements)
    logical, allocatable, private :: pending(:)
    !> Plies that may soften; without a ply: any, where strengths vary
    type(loaded_plies_t), private :: loaded
  contains
    procedure :: soften
    procedure :: needs_joined_strains
    procedure :: accumulate_strains
    procedure :: exchange
    procedure :: commit
    procedure :: commit_sections
    procedure :: update_strengths
    procedure :: elasticity
    procedure :: visit
  end type crack_band_sections_t

contains

  !> Plies without damage.
  function new_crack_band_sections(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(crack_band_sections_t) :: self
    integer :: i

    call find_laws(plate, self%plies, self%bands)
    if (allocated(plate%layup%free)) then
      self%free = plate%layup%free
    else if (plate%setup%ply_damage%permanent_shear .or. plate%setup%ply_damage%crack_closure &
             .or. plate%setup%is_bimodular()) then
      allocate (self%free(lanes, 7, plate%elements%batches), source=0.0_wp)
    end if
    if (plate%setup%is_bimodular()) then
      self%signs = new_mean_sections(plate)
      self%tensile = self%free
    end if
    self%states = new_band_states(plate)
    self%joined = find_joined_elements(plate)
    self%onset = [(onset_strain(self%bands(i)), i=1, size(self%bands))]
    if (plate%setup%ply_damage%scatters()) then
      self%drawn = new_drawn_strengths(plate, self%plies, self%states, self%joined%joined)
      self%onset = [(onset_strain(self%drawn%law(self%bands(i), self%states, i)), i=1, size(self%bands))]
    end if
    self%height = max(abs(self%plies%z_top), abs(self%plies%z_bottom))
    if (plate%setup%ply_damage%weibull_modulus > 0 .and. .not. allocated(self%drawn)) then
      self%volumes = new_stressed_volumes(plate, self%bands, self%states)
      self%onset = min(self%onset, self%volumes%smallest_strain(self%bands))
    end if
    if (plate%setup%has_rates()) self%rates = new_loading_rates(plate, size(self%states%trial))
    if (plate%setup%counts_rates()) self%onset = 0
    self%onset = self%onset - [(norm2(self%plies(i)%free_strain), i=1, size(self%plies))]
    self%stiffness = plate%elements%stiffness
    allocate (self%sides(2, plate%elements%elements), self%area(plate%elements%elements))
    allocate (self%touched(plate%elements%elements), self%pending(plate%elements%elements), source=.false.)
    allocate (self%limits(lanes, 2, plate%elements%batches), source=0.0_wp)
    do i = 1, plate%elements%elements
      associate (place => plate%mesh%place_of(plate%mesh%element_cell(plate%distribution%elements(i))))
        self%area(i) = plate%mesh%cell_area(place)
        self%sides(:, i) = plate%mesh%cell_sides(place)*merge(2, 1, self%joined%joined(:, i))
      end associate
      associate (first => self%states%range(1, i), last => self%states%range(2, i))
        self%limits(lane_of(i), :, batch_of(i)) = [minval(self%onset(first:last)), maxval(self%height(first:last))]
      end associate
    end do
    self%strengths_vary = allocated(self%rates) .or. allocated(self%volumes) .or. allocated(self%drawn)
    if (.not. self%strengths_vary) &
      self%loaded = new_loaded_plies(self%plies, self%bands, self%states, self%onset, self%height)
  end function new_crack_band_sections

  !> True for a batch with elements that share their state.
  pure logical function needs_joined_strains(self, b)
    class(crack_band_sections_t), intent(in) :: self
    integer, intent(in) :: b

    needs_joined_strains = self%joined%concerned(b)
  end function needs_joined_strains

  !> Accumulates the strains of elements that share their state.
  subroutine accumulate_strains(self, b, weight, strains)
    class(crack_band_sections_t), intent(inout) :: self
    integer, intent(in) :: b
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    real(wp) :: sizes(lanes, 2), moments(lanes, moment_values)
    integer :: lane, element

    sizes = strain_sizes(weight, strains)
    moments = strain_moments(weight, strains)
    do lane = 1, min(lanes, size(self%touched) - first_element(b) + 1)
      element = first_element(b) + lane - 1
      if (.not. self%joined%shares(element)) cycle
      associate (first => self%states%range(1, element), last => self%states%range(2, element), &
                 offset => self%states%offset(element))
        call self%joined%accumulate_strains(element, moments(lane, :), &
                                            sizes(lane, 1) + self%limits(lane, 2, b)*sizes(lane, 2), &
                                            self%plies(first:last), self%bands(first:last), &
                                            self%states%accepted(offset + first:offset + last))
      end associate
    end do
  end subroutine accumulate_strains

  !> Sends them to all ranks. Collective.
  subroutine exchange(self)
    class(crack_band_sections_t), intent(inout) :: self

    call self%joined%exchange()
  end subroutine exchange

  !> Stiffness of the sections of a batch under trial strains.
  subroutine soften(self, b, weight, strains, stiffness, free)
    !> The plies; store the trial state
    class(crack_band_sections_t), intent(inout) :: self
    integer, intent(in) :: b
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    real(wp), intent(inout) :: stiffness(lanes, 21)
    real(wp), intent(inout), optional :: free(lanes, 7)
    real(wp) :: sizes(lanes, 2), moments(lanes, moment_values)
    logical :: strained(lanes), loaded(lanes), changed
    integer :: first, last, lane

    first = first_element(b)
    last = min(first + lanes - 1, size(self%touched))
    if (allocated(self%volumes)) call self%volumes%clear(self%states, first, last)
    sizes = strain_sizes(weight, strains)
    strained = .not. self%joined%joined_bounds(b, sizes(:, 1) + self%limits(:, 2, b)*sizes(:, 2)) < self%limits(:, 1, b)
    strained(:last - first + 1) = strained(:last - first + 1) .or. self%touched(first:last)
    if (any(strained(:last - first + 1))) then
      moments = strain_moments(weight, strains)
      loaded = self%loaded%may_soften(b, self%joined%joined_moments(b, moments))
      do lane = 1, last - first + 1
        if (.not. strained(lane)) cycle
        changed = self%keeps_damage
        if (.not. (changed .or. loaded(lane) .or. self%pending(first + lane - 1))) cycle
        if (.not. changed) call soften_element(self, first + lane - 1, moments_from(moments(lane, :)), &
                                               stiffness(lane, :), changed)
        if (.not. changed) cycle
        if (present(free)) free(lane, :) = resultants_without_strain(self%plies, self%bands, self%states, &
                                                                     first + lane - 1, .not. allocated(self%signs))
        if (allocated(self%signs)) self%tensile(lane, :, b) = free(lane, :)
      end do
      self%stiffness(:, :, b) = stiffness
    end if
    if (allocated(self%signs)) free = self%tensile(:, :, b) + &
      signed_resultants(self%signs, self%plies, self%bands, self%states, self%joined, self%touched, b, weight, strains)
    if (present(free)) self%free(:, :, b) = free
  end subroutine soften

  !> Damage of the plies of one element under trial strains, and its section.
  pure subroutine soften_element(self, element, moments, stiffness, changed)
    class(crack_band_sections_t), intent(inout) :: self
    integer, intent(in) :: element
    !> Its strains
    type(strain_moments_t), intent(in) :: moments
    !> Section stiffness
    real(wp), intent(inout) :: stiffness(21)
    !> True: the stress-free strains or the stiffness of a ply may have changed
    logical, intent(out) :: changed
    type(band_strains_t) :: strains
    type(strain_moments_t) :: joined
    real(wp), allocatable :: means(:)
    real(wp) :: before(3), membrane, curvature
    logical :: loses
    integer :: ply

    loses = .false.
    self%touched(element) = .false.
    self%pending(element) = .true.
    joined = moments
    if (self%joined%shares(element)) then
      means = self%joined%means_of(element, self%joined%values)
      joined = moments_from(means(:moment_values))
    end if
    membrane = invariant_measure(joined%membrane)
    curvature = invariant_measure(joined%curvature)
    associate (first => self%states%range(1, element), last => self%states%range(2, element), &
               offset => self%states%offset(element))
      do ply = first, last
        associate (old => self%states%accepted(offset + ply), new => self%states%trial(offset + ply))
          before = stiffness_lost(new)
          new = old
          ! The bound of `strain_sizes` for one ply.
          if (is_damaged(old) .or. .not. membrane + self%height(ply)*curvature < self%onset(ply)) then
            call find_elastic_strains(ply - first + 1, self%plies(ply), self%bands(ply), moments, joined, means, new, &
                                      strains)
            if (self%strengths_vary .or. may_soften(self%bands(ply), strains, old)) &
              call soften_ply(self, element, ply, joined, strains, new)
          end if
          loses = loses .or. any(abs(stiffness_lost(new) - before) > 0)
          self%touched(element) = self%touched(element) .or. is_damaged(new)
        end associate
      end do
      if (loses) stiffness(:18) = in_plane_section(self%plies(first:last), degraded_elasticity(self%bands(first:last), &
                                                   self%states%trial(offset + first:offset + last)))
      changed = loses .or. any(self%bands(first:last)%permanent_shear .or. self%bands(first:last)%crack_closure)
    end associate
  end subroutine soften_element

  !> Damage of a ply of an element under its trial strains.
  pure subroutine soften_ply(self, element, ply, moments, strains, new)
    class(crack_band_sections_t), intent(inout) :: self
    !> Element of this rank, and the ply
    integer, intent(in) :: element, ply
    !> Strains of the element with those joined with it
    type(strain_moments_t), intent(in) :: moments
    !> Elastic strains of the ply
    type(band_strains_t), intent(in) :: strains
    !> The accepted state with the present permanent strain; receives the damage
    type(band_state_t), intent(inout) :: new
    type(crack_band_t) :: law
    real(wp) :: normal(2), factor

    factor = 1
    law = self%bands(ply)
    associate (at => self%states%offset(element) + ply, sides => self%sides(:, element))
      if (allocated(self%drawn)) law%along(1) = law%along(1)*self%drawn%factor(at)
      if (allocated(self%rates)) call self%rates%find_factor(at, self%plies(ply), self%bands(ply), moments, factor)
      ! Mean width of the elements normal to a straight crack.
      normal = abs([self%plies(ply)%cosine, self%plies(ply)%sine])
      call soften_band(law, [dot_product(normal, sides), dot_product(normal, sides([2, 1]))], strains, &
                       self%states%accepted(at), new, factor)
      if (allocated(self%volumes)) self%volumes%stress(at) = tensile_stress(self%bands(ply), strains, new)
    end associate
  end subroutine soften_ply

  !> Accepts the trial state.
  pure subroutine commit(self)
    class(crack_band_sections_t), intent(inout) :: self
    integer :: element

    if (allocated(self%rates)) call self%rates%accept()
    do element = 1, size(self%pending)
      if (.not. self%pending(element)) cycle
      self%pending(element) = .false.
      if (.not. self%touched(element)) cycle
      call self%states%accept(element)
      call self%loaded%update(element, self%bands, self%states)
    end do
  end subroutine commit

  !> Accepts the trial state, and returns the sections of changed elements.
  pure subroutine commit_sections(self, stiffness, free)
    class(crack_band_sections_t), intent(inout) :: self
    real(wp), intent(inout) :: stiffness(:, :, :)
    !> Resultants of stress-free strains, (lanes, 7, batches); unallocated: there are none
    real(wp), allocatable, intent(inout) :: free(:, :, :)
    integer :: element

    call self%commit()
    do element = 1, size(self%touched)
      if (.not. self%touched(element)) cycle
      stiffness(lane_of(element), :, batch_of(element)) = self%stiffness(lane_of(element), :, batch_of(element))
      if (allocated(free)) &
        free(lane_of(element), :, batch_of(element)) = self%free(lane_of(element), :, batch_of(element))
    end do
  end subroutine commit_sections

  !> Tensile strengths of fibres for their stressed volumes in the accepted state, which must be the last trial; those
  !> loaded remain until there is a trial. Collective.
  subroutine update_strengths(self, plate)
    class(crack_band_sections_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate

    if (.not. allocated(self%volumes)) return
    call self%volumes%update(plate%communicator, plate%layup, self%states, self%plies, self%area)
    self%bands%along(1) = self%volumes%strengths()
  end subroutine update_strengths

  !> Reduced elastic constants of a ply of an element.
  pure function elasticity(self, ply, element)
    class(crack_band_sections_t), intent(in) :: self
    !> Number of the ply, and element of this rank whose cell has it
    integer, intent(in) :: ply, element
    type(elasticity_t) :: elasticity
    integer :: at

    at = self%states%at(ply, element)
    associate (band => self%bands(at - self%states%offset(element)))
      elasticity = band%elasticity
      if (self%touched(element)) elasticity = degraded_elasticity(band, self%states%trial(at))
    end associate
  end function elasticity

  !> Saves or loads the accepted state.
  subroutine visit(self, archive, plate)
    class(crack_band_sections_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    integer :: element

    call self%states%visit(archive, plate)
    if (allocated(self%rates)) call self%rates%visit(archive, plate, self%states%range, self%states%offset, &
                                                          self%states%number)
    if (allocated(self%volumes)) call self%volumes%visit(archive)
    if (.not. archive%loading) return
    if (allocated(self%volumes)) self%bands%along(1) = self%volumes%strengths()
    self%pending = .false.
    do element = 1, size(self%touched)
      call self%loaded%update(element, self%bands, self%states)
      self%touched(element) = self%states%damaged(element)
      if (self%touched(element) .and. allocated(self%signs)) self%tensile(lane_of(element), :, batch_of(element)) = &
        resultants_without_strain(self%plies, self%bands, self%states, element, .false.)
    end do
  end subroutine visit
end module crack_band_sections
