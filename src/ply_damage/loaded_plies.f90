!> Plies that may lose stiffness under the strains of a batch, over lanes of elements. The others only unload, and keep
!> their state: what may fail further is exposed by less than at its damage. This is `may_soften` for plies whose damage
!> alone is their history, without the sign of the stresses, and it compares squares.
module loaded_plies
  use band_states, only: band_states_t
  use crack_bands, only: crack_band_t, remaining_stiffness
  use element_batches, only: batch_of, first_element, lane_of, lanes
  use kinds, only: wp
  use linear_softening, only: min_ratio
  use plies, only: ply_t
  use ply_damage_parameters, only: criteria_hashin, criteria_hou
  use ply_strains, only: moment_values
  use roundings, only: rounding
  implicit none
  private
  public :: loaded_plies_t, new_loaded_plies

  !> A ply of each element of a batch. Its values are zero where an element has fewer plies. It has many components
  !> because each is a factor that strains or laws would give again in every step.
  type :: ply_lanes_t
    !> Squares and product of the cosine and sine of its angle
    real(wp) :: cosine(lanes) = 0, sine(lanes) = 0, product(lanes) = 0
    !> Height of its middle, and mean square of its heights
    real(wp) :: middle(lanes) = 0, spread(lanes) = 0
    !> Stress-free strains along and across the fibres
    real(wp) :: free(lanes, 2) = 0
    !> Distance of its outer face from the middle surface, and strain below which damage does not start
    real(wp) :: height(lanes) = 0, onset(lanes) = huge(1.0_wp)
    !> Poisson's ratios with its damage
    real(wp) :: nu12(lanes) = 0, nu21(lanes) = 0
    !> Exposure of its fibres, squared, over the squares of the strain along them
    real(wp) :: fibres(lanes) = 0
    !> Stress over strain across the fibres, with that of the strain along them in compression, and the square of that
    !> in shear over the shear strength
    real(wp) :: across(lanes) = 0, along(lanes) = 0, shear(lanes) = 0
    !> Squares of the stress across the fibres in the exposures in tension and in compression, and its factor in the
    !> latter
    real(wp) :: tension(lanes) = 0, compression(lanes) = 0, linear(lanes) = 0
  end type ply_lanes_t

  !> The plies of this rank's elements.
  type :: loaded_plies_t
    !> The plies of one batch after the other; unallocated: any ply may soften
    type(ply_lanes_t), allocatable, private :: plies(:)
    !> First row of each batch, (batches + 1)
    integer, allocatable, private :: first(:)
  contains
    procedure :: may_soften
    procedure :: update
  end type loaded_plies_t

contains

  !> Plies in their accepted states.
  pure function new_loaded_plies(plies, bands, states, onset, height) result(self)
    !> Plies of the different laminates, one after the other
    type(ply_t), intent(in) :: plies(:)
    !> Their laws
    type(crack_band_t), intent(in) :: bands(:)
    type(band_states_t), intent(in) :: states
    !> Strain below which damage does not start in each ply, and distance of its outer face from the middle surface
    real(wp), intent(in) :: onset(:), height(:)
    type(loaded_plies_t) :: self
    integer :: element, b, row

    if (any(bands%kinking .or. bands%crack_closure .or. bands%shear_beta > 0)) return
    if (.not. all(bands%matrix%criteria == criteria_hashin .or. bands%matrix%criteria == criteria_hou)) return
    if (size(states%offset) == 0) return
    allocate (self%first(batch_of(size(states%offset)) + 1))
    self%first(1) = 1
    do b = 1, size(self%first) - 1
      associate (last => min(first_element(b + 1) - 1, size(states%offset)))
        self%first(b + 1) = self%first(b) + 1 + maxval(states%range(2, first_element(b):last) &
                                                       - states%range(1, first_element(b):last))
      end associate
    end do
    allocate (self%plies(self%first(size(self%first)) - 1))
    do element = 1, size(states%offset)
      associate (first => states%range(1, element), last => states%range(2, element), lane => lane_of(element))
        do row = first, last
          associate (ply => plies(row), lane_row => self%plies(self%first(batch_of(element)) + row - first))
            lane_row%cosine(lane) = ply%cosine**2
            lane_row%sine(lane) = ply%sine**2
            lane_row%product(lane) = ply%cosine*ply%sine
            lane_row%middle(lane) = (ply%z_top + ply%z_bottom)/2
            lane_row%spread(lane) = lane_row%middle(lane)**2 + (ply%z_bottom - ply%z_top)**2/12
            lane_row%free(lane, 1) = ply%free_strain(1)
            lane_row%free(lane, 2) = ply%free_strain(2)
            lane_row%height(lane) = height(row)
            lane_row%onset(lane) = onset(row)
          end associate
        end do
      end associate
      call self%update(element, bands, states)
    end do
  end function new_loaded_plies

  !> Updates the plies of an element to their accepted states.
  pure subroutine update(self, element, bands, states)
    class(loaded_plies_t), intent(inout) :: self
    integer, intent(in) :: element
    type(crack_band_t), intent(in) :: bands(:)
    type(band_states_t), intent(in) :: states
    integer :: ply

    if (.not. allocated(self%plies)) return
    do ply = states%range(1, element), states%range(2, element)
      call set_lane(self%plies(self%first(batch_of(element)) + ply - states%range(1, element)), lane_of(element), &
                    bands(ply), states%accepted(states%offset(element) + ply)%damage)
    end do
  end subroutine update

  !> Sets the exposures of a ply with its damage. It grows where the exposure exceeds that at which the law of the
  !> smallest ratio N has this damage, 1/(1 - d + d/N).
  pure subroutine set_lane(self, lane, band, damage)
    type(ply_lanes_t), intent(inout) :: self
    !> The lane of the element
    integer, intent(in) :: lane
    !> Law of the ply
    type(crack_band_t), intent(in) :: band
    !> Of fibres and matrix
    real(wp), intent(in) :: damage(2)
    real(wp) :: left(2), reduction(2), divisor, stiffer

    left = remaining_stiffness(band, damage)
    ! 0: nothing is left that may fail.
    reduction = merge(1 - damage + damage/min_ratio, 0.0_wp, damage < 1)
    associate (c => band%elasticity, m => band%matrix)
      stiffer = max(1.0_wp, c%compression)
      self%nu21(lane) = left(2)*c%nu12*c%e2/c%e1
      self%nu12(lane) = left(1)*c%nu12
      divisor = (1 - self%nu12(lane)*self%nu21(lane)*stiffer)*(1 - rounding)
      self%fibres(lane) = stiffer*(reduction(1)*c%e1/divisor)**2*max(1/band%along(1)**2, c%compression/band%along(2)**2)
      self%across(lane) = reduction(2)*c%e2/divisor
      self%along(lane) = self%across(lane)*abs(self%nu12(lane)*(c%compression - 1))
      self%shear(lane) = (reduction(2)*c%g12/(m%shear*(1 - rounding)))**2
      self%tension(lane) = 1/m%tension**2
      self%compression(lane) = 1/(2*m%shear_across)**2
      self%linear(lane) = (1 - (m%compression/(2*m%shear_across))**2)/m%compression
    end associate
  end subroutine set_lane

  !> False for elements in which no ply loses stiffness.
  pure function may_soften(self, b, moments) result(loaded)
    class(loaded_plies_t), intent(in) :: self
    integer, intent(in) :: b
    !> Moments of the strains of its elements, or their means over those that share their state, from `strain_moments`
    real(wp), intent(in) :: moments(lanes, moment_values)
    !> One for each lane
    logical :: loaded(lanes)
    real(wp), dimension(lanes, 6) :: membrane, mixed, curvature
    real(wp), dimension(lanes) :: strain, bending
    logical :: exceeds(lanes)
    integer :: row

    loaded = .not. allocated(self%plies)
    if (all(loaded)) return
    membrane = moments(:, [7, 11, 15, 8, 9, 12])
    mixed = moments(:, [16, 20, 24, 17, 18, 21]) + moments(:, [16, 20, 24, 19, 22, 23])
    curvature = moments(:, [25, 29, 33, 26, 27, 30])
    strain = sqrt(membrane(:, 1) + membrane(:, 2) + membrane(:, 3)/2)
    bending = sqrt(curvature(:, 1) + curvature(:, 2) + curvature(:, 3)/2)
    do row = self%first(b), self%first(b + 1) - 1
      exceeds = .not. strain + self%plies(row)%height*bending < self%plies(row)%onset
      if (.not. any(exceeds .and. .not. loaded)) cycle
      loaded = loaded .or. exceeds .and. are_exposed(self%plies(row), moments(:, :6), membrane, mixed, curvature)
    end do
  end function may_soften

  !> True where a ply is exposed beyond its damage.
  pure function are_exposed(ply, mean, membrane, mixed, curvature) result(exposed)
    type(ply_lanes_t), intent(in) :: ply
    !> Mean strains
    real(wp), intent(in) :: mean(lanes, 6)
    !> Mean products of strains 11, 22, 33, 12, 13, 23: of membrane strains, of both and their transpose, of curvatures
    real(wp), dimension(lanes, 6), intent(in) :: membrane, mixed, curvature
    !> One for each lane
    logical :: exposed(lanes)
    real(wp), dimension(lanes) :: fibres, tension, compression
    real(wp) :: p(6), mean_along, mean_across, along, across, both, shear, stress
    integer :: i, k

    do i = 1, lanes
      do k = 1, 6
        p(k) = membrane(i, k) + ply%middle(i)*mixed(i, k) + ply%spread(i)*curvature(i, k)
      end do
      associate (a => ply%cosine(i), b => ply%sine(i), d => ply%product(i), free => ply%free(i, 1), &
                 free_across => ply%free(i, 2), x => mean(i, 1) + ply%middle(i)*mean(i, 4), &
                 y => mean(i, 2) + ply%middle(i)*mean(i, 5), xy => mean(i, 3) + ply%middle(i)*mean(i, 6))
        mean_along = a*x + b*y + d*xy
        mean_across = b*x + a*y - d*xy
        along = a*a*p(1) + b*b*p(2) + d*(d*p(3) + 2*(a*p(5) + b*p(6))) + 2*a*b*p(4) - (2*mean_along - free)*free
        across = b*b*p(1) + a*a*p(2) + d*(d*p(3) - 2*(b*p(5) + a*p(6))) + 2*a*b*p(4) &
                 - (2*mean_across - free_across)*free_across
        both = a*b*(p(1) + p(2)) - d*d*p(3) + (a*a + b*b)*p(4) + (a - b)*d*(p(6) - p(5)) &
               - (mean_along*free_across + mean_across*free - free*free_across)
        shear = 4*d*d*(p(1) + p(2) - 2*p(4)) + (a - b)**2*p(3) + 4*(a - b)*d*(p(6) - p(5))
      end associate
      stress = ply%across(i)*sqrt(max(0.0_wp, across + ply%nu12(i)*(2*both + ply%nu12(i)*along))) &
               + ply%along(i)*sqrt(max(0.0_wp, along))
      shear = ply%shear(i)*max(0.0_wp, shear)
      fibres(i) = ply%fibres(i)*(along + ply%nu21(i)*(2*both + ply%nu21(i)*across))
      tension(i) = ply%tension(i)*stress**2 + shear
      compression(i) = (ply%compression(i)*stress + ply%linear(i))*stress + shear
    end do
    exposed = .not. (fibres < 1 .and. tension < 1 .and. compression < 1)
  end function are_exposed
end module loaded_plies
