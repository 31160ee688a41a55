!> Distribution over ranks: METIS distributes the cells, the points of a node belong to one rank, and every rank keeps
!> copies (ghosts) of the points its elements touch but does not own.
module distributions
  use errors, only: error_t
  use communicators, only: communicator_t
  use partitions, only: partition_graph
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: distribution_t, distribute

  !> One rank's part of the mesh.
  type :: distribution_t
    !> Elements of this rank
    integer, allocatable :: elements(:)
    !> Points of this rank, the owned ones first, then ghosts; both in ascending rank order
    integer, allocatable :: points(:)
    !> Number of points owned
    integer :: owned = 0
    !> First rank-ordered number of each rank's points, (0:ranks)
    integer, allocatable :: first(:)
    !> Rank-ordered number (from 0) of every point of the mesh
    integer, allocatable :: number(:)
    !> Position of every point of the mesh among this rank's; 0: not here
    integer, allocatable :: local(:)
    !> Position of every element of the mesh among this rank's; 0: not here
    integer, allocatable :: local_element(:)
    !> Points of this rank's elements as positions, (9, elements)
    integer, allocatable :: connectivity(:, :)
  end type distribution_t

contains

  !> Distributes the mesh over the ranks of a communicator. Every rank finds the same distribution.
  subroutine distribute(mesh, communicator, self, error, first_image)
    type(layered_mesh_t), intent(in) :: mesh
    type(communicator_t), intent(in) :: communicator
    type(distribution_t), intent(out) :: self
    type(error_t), allocatable, intent(out) :: error
    !> First of the images of each cell, including itself, which are all assigned to one rank; left out: no images
    integer, intent(in), optional :: first_image(:)
    integer :: owner(mesh%points()), first(product(mesh%cells))
    integer, allocatable :: part(:)
    integer :: element

    first = [(element, element=1, size(first))]
    if (present(first_image)) first = first_image
    call partition_cells(mesh, communicator%size, first, part, error)
    if (allocated(error)) return
    call own_points(mesh, part, owner)
    call number_points(owner, communicator%size, self)
    self%elements = pack([(element, element=1, mesh%elements())], part(mesh%element_cell) == communicator%rank)
    allocate (self%local_element(mesh%elements()), source=0)
    self%local_element(self%elements) = [(element, element=1, size(self%elements))]
    call gather_points(mesh, communicator%rank, owner, self)
    allocate (self%connectivity(9, size(self%elements)))
    do element = 1, size(self%elements)
      self%connectivity(:, element) = self%local(mesh%connectivity(:, self%elements(element)))
    end do
  end subroutine distribute

  !> Distributes cells over ranks, weighted by their elements; images of each other are assigned to one rank.
  subroutine partition_cells(mesh, ranks, first, part, error)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: ranks
    !> First of the images of each cell, including itself
    integer, intent(in) :: first(:)
    !> Rank of each cell
    integer, allocatable, intent(out) :: part(:)
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: row_start(:), neighbours(:), folded_start(:), folded(:), part_of_first(:), work(:)
    integer :: cell, firsts, place(size(first))

    call cell_graph(mesh, row_start, neighbours)
    place = 0
    allocate (folded_start(count(first == [(cell, cell=1, size(first))]) + 1), folded(size(neighbours)))
    folded_start(1) = 1
    firsts = 0
    do cell = 1, size(first)
      if (first(cell) /= cell) cycle
      firsts = firsts + 1
      place(cell) = firsts
    end do
    do cell = 1, size(first)
      if (first(cell) /= cell) cycle
      associate (around => place(neighbours(row_start(cell):row_start(cell + 1) - 1)), &
                 here => folded_start(place(cell)), next => folded_start(place(cell) + 1))
        next = here + count(around > 0)
        folded(here:next - 1) = pack(around, around > 0)
      end associate
    end do
    folded = folded(:folded_start(firsts + 1) - 1)
    allocate (work(firsts), source=0)
    do cell = 1, mesh%elements()
      associate (its => work(place(first(mesh%element_cell(cell)))))
        its = its + 1
      end associate
    end do
    call partition_graph(folded_start, folded, ranks, part_of_first, error, work)
    if (.not. allocated(error)) part = part_of_first(place(first))
  end subroutine partition_cells

  !> Graph of the cells that share an edge, compressed rows.
  pure subroutine cell_graph(mesh, row_start, neighbours)
    type(layered_mesh_t), intent(in) :: mesh
    !> Start of each cell's neighbours, (cells + 1)
    integer, allocatable, intent(out) :: row_start(:)
    !> Neighbours
    integer, allocatable, intent(out) :: neighbours(:)
    integer :: i, j, cell, found, nearby(4)

    allocate (row_start(product(mesh%cells) + 1), neighbours(4*product(mesh%cells)))
    found = 0
    do j = 1, mesh%cells(2)
      do i = 1, mesh%cells(1)
        cell = mesh%cell_at(i, j)
        row_start(cell) = found + 1
        nearby = [merge(mesh%cell_at(i - 1, j), 0, i > 1), merge(mesh%cell_at(i + 1, j), 0, i < mesh%cells(1)), &
                  merge(mesh%cell_at(i, j - 1), 0, j > 1), merge(mesh%cell_at(i, j + 1), 0, j < mesh%cells(2))]
        neighbours(found + 1:found + count(nearby > 0)) = pack(nearby, nearby > 0)
        found = found + count(nearby > 0)
      end do
    end do
    row_start(cell + 1) = found + 1
    neighbours = neighbours(:found)
  end subroutine cell_graph

  !> Assigns each point to the lowest rank with a cell at its node or at its master node.
  pure subroutine own_points(mesh, part, owner)
    type(layered_mesh_t), intent(in) :: mesh
    !> Rank of each cell
    integer, intent(in) :: part(:)
    !> Rank of each point, from 0
    integer, intent(out) :: owner(:)
    integer :: node_owner(mesh%nodes()), cell, node, nodes(9)

    node_owner = huge(1)
    do cell = 1, size(part)
      nodes = mesh%cell_nodes(cell)
      node_owner(nodes) = min(node_owner(nodes), part(cell))
    end do
    ! Dependent nodes and their masters belong to one rank.
    do node = 1, mesh%nodes()
      if (.not. mesh%is_dependent(node)) cycle
      nodes(:2) = [node, mesh%turned_node(node)]
      node_owner(nodes(:2)) = minval(node_owner(nodes(:2)))
    end do
    owner = node_owner(mesh%point_node)
  end subroutine own_points

  !> Numbers the points rank by rank.
  pure subroutine number_points(owner, ranks, self)
    !> Rank of each point
    integer, intent(in) :: owner(:)
    integer, intent(in) :: ranks
    type(distribution_t), intent(inout) :: self
    integer :: next(0:ranks), point, rank

    next = 0
    do point = 1, size(owner)
      next(owner(point) + 1) = next(owner(point) + 1) + 1
    end do
    do rank = 1, ranks
      next(rank) = next(rank) + next(rank - 1)
    end do
    allocate (self%first(0:ranks), self%number(size(owner)))
    self%first = next
    do point = 1, size(owner)
      self%number(point) = next(owner(point))
      next(owner(point)) = next(owner(point)) + 1
    end do
  end subroutine number_points

  !> Lists this rank's points: owned, then ghosts.
  pure subroutine gather_points(mesh, rank, owner, self)
    type(layered_mesh_t), intent(in) :: mesh
    !> This rank
    integer, intent(in) :: rank
    !> Rank of each point
    integer, intent(in) :: owner(:)
    !> Receives `points`, `owned` and `local`
    type(distribution_t), intent(inout) :: self
    logical :: touched(size(owner))
    integer :: in_order(size(owner)), point, element

    touched = .false.
    do element = 1, size(self%elements)
      touched(mesh%connectivity(:, self%elements(element))) = .true.
    end do
    touched = touched .and. owner /= rank
    in_order(self%number + 1) = [(point, point=1, size(owner))]
    self%owned = count(owner == rank)
    self%points = [pack(in_order, owner(in_order) == rank), pack(in_order, touched(in_order))]
    allocate (self%local(size(owner)), source=0)
    self%local(self%points) = [(point, point=1, size(self%points))]
  end subroutine gather_points
end module distributions
