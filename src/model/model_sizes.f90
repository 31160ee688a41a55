!> Size of a model before it is built: unknowns and memory, for `implam check` and job scripts.
module model_sizes
  use kinds, only: wp
  use layer_extents, only: largest_extents
  use interface_zones, only: zone_t
  use idle_membranes, only: is_membrane_idle
  use layered_zones, only: zones_of
  use cell_lines, only: cell_line_t
  use cell_grids, only: cells_along
  use setups, only: setup_t
  use stacking, only: section_of, stacked_plies
  use text, only: counted, to_text
  implicit none
  private
  public :: model_size_t, size_of_model

  !> Unknowns per rank in a job script; a choice, since the best value depends on the machine.
  integer, parameter :: unknowns_a_rank = 25000
  !> Megabytes of the libraries per process: MPI, PETSc and the libraries these use (doc/studies/speed.md).
  real(wp), parameter :: megabytes_of_libraries = 55
  !> Bytes per pair of unknowns of a node times log2 of the number of nodes: fill-in of a plane grid by nested
  !> dissection. Measured, doc/manual/queue.md.
  real(wp), parameter :: bytes_whole = 60, bytes_layered = 93
  !> Bytes per element of a layer without a factorization. Measured: 4400 in an elastic plate, 5400 with cohesive
  !> interfaces, 9700 with crack bands too (T700/M21 panel on cells of 1 mm). With adaptive layers the state is in
  !> memory twice during their extension: 13700 and 14900 in total on cells of 1.5 and 3 mm.
  real(wp), parameter :: bytes_explicit = 9700, bytes_transferred = 5000
  !> Memory of several ranks together over that of one: MUMPS' buffers and ghosts. Measured, doc/manual/queue.md.
  real(wp), parameter :: more_on_ranks = 1.7_wp

  !> Size of a model.
  type :: model_size_t
    !> Number of unknowns, including those fixed by supports, without in-plane ones that are always zero
    integer :: unknowns = 0
    !> Elements of all layers
    real(wp) :: elements = 0
    !> Recommended number of ranks
    integer :: ranks = 1
    !> Megabytes beyond those of the libraries, on one rank
    real(wp) :: megabytes = 0
    !> True: upper bounds, with adaptive layers
    logical :: at_most = .false.
  contains
    procedure :: megabytes_a_rank
    procedure :: sentence
  end type model_size_t

contains

  !> Size of the model of a setup.
  pure function size_of_model(setup, explicit) result(size_found)
    !> The setup; it has passed the deck's checks
    type(setup_t), intent(in) :: setup
    !> True: central differences, without a factor
    logical, intent(in) :: explicit
    type(model_size_t) :: size_found
    type(zone_t), allocatable :: zones(:)
    type(cell_line_t) :: line
    integer :: cells(2), i, j, a_node
    real(wp) :: nodes, inside, pairs, bytes

    zones = zones_of(with_largest_zones(setup, explicit))
    do i = 1, 2
      line = cells_along(setup%plate, setup%mesh, i)
      cells(i) = line%cells()
    end do
    nodes = product(2*real(cells, wp) + 1)
    a_node = 5
    if (is_membrane_idle(setup, size(zones), section_of(stacked_plies(setup%laminate, setup%materials), &
                                                        setup%laminate%shear_correction))) a_node = 3
    pairs = nodes
    if (allocated(setup%delaminations)) size_found%at_most = any(setup%delaminations%is_adaptive)
    size_found%elements = product(real(cells, wp))
    size_found%unknowns = nint(a_node*nodes)
    ! A node has an additional layer for each zone that contains it: (1 + sum)**2 pairs, summed over pairs of zones.
    do i = 1, size(zones)
      inside = nodes_in_both(zones(i), zones(i), cells)
      size_found%elements = size_found%elements + product([zones(i)%columns(2) - zones(i)%columns(1), &
                                                           zones(i)%rows(2) - zones(i)%rows(1)] + 1.0_wp)
      size_found%unknowns = size_found%unknowns + nint(5*inside)
      pairs = pairs + 2*inside + sum([(nodes_in_both(zones(i), zones(j), cells), j=1, size(zones))])
    end do
    size_found%ranks = max(1, nint(real(size_found%unknowns, wp)/unknowns_a_rank))
    if (explicit) then
      bytes = bytes_explicit
      if (size_found%at_most) bytes = bytes + bytes_transferred
      size_found%megabytes = 1.0e-6_wp*bytes*size_found%elements
      return
    end if
    size_found%megabytes = 1.0e-6_wp*merge(bytes_layered, bytes_whole, size(zones) > 0)*a_node**2*pairs*log(nodes)/ &
                           log(2.0_wp)
  end function size_of_model

  !> The setup with the largest zones that adaptive layers may reach: the full plate with central differences, where
  !> waves of failing fibres may reach the strength of interfaces anywhere; the core with implicit steps.
  pure function with_largest_zones(setup, explicit) result(largest)
    type(setup_t), intent(in) :: setup
    !> True: central differences
    logical, intent(in) :: explicit
    !> The same with other zones
    type(setup_t) :: largest
    integer :: i

    largest = setup
    if (.not. allocated(setup%delaminations)) return
    do i = 1, size(setup%delaminations)
      if (.not. setup%delaminations(i)%is_adaptive) cycle
      largest%delaminations(i)%zone_at = 0
      largest%delaminations(i)%zone = largest_extents(setup%delaminations(i)%zone, setup%mesh%core, &
                                                      merge(0.0_wp, setup%mesh%cell, explicit), setup%plate%length)
    end do
  end function with_largest_zones

  !> Number of nodes inside two zones; the border of the model counts as inside.
  pure real(wp) function nodes_in_both(a, b, cells) result(nodes)
    !> The zones
    type(zone_t), intent(in) :: a, b
    !> Columns and rows of cells
    integer, intent(in) :: cells(2)
    integer :: first(2), last(2)

    first = [max(a%columns(1), b%columns(1)), max(a%rows(1), b%rows(1))]
    last = [min(a%columns(2), b%columns(2)), min(a%rows(2), b%rows(2))]
    nodes = product(max(0.0_wp, 2*real(last - first + 1, wp) - 1 + merge(1, 0, first == 1) + &
                        merge(1, 0, last == cells)))
  end function nodes_in_both

  !> Megabytes that a rank needs.
  pure real(wp) function megabytes_a_rank(self, ranks) result(megabytes)
    class(model_size_t), intent(in) :: self
    integer, intent(in) :: ranks

    megabytes = megabytes_of_libraries + self%megabytes*merge(1.0_wp, more_on_ranks/ranks, ranks == 1)
  end function megabytes_a_rank

  !> Sentence of `implam check`.
  pure function sentence(self) result(words)
    class(model_size_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = trim(merge('At most', 'About  ', self%at_most))//' '// &
            counted(to_text(self%unknowns), 'unknown')//' and '// &
            to_text(nint(self%megabytes_a_rank(1)))//' MB of memory on one rank.'
  end function sentence
end module model_sizes
