!> Plies of the plate: its laminates, and the plies of each element.
module layups
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use element_batches, only: batch_of, lane_of, lanes
  use free_strains, only: free_resultants
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use layered_meshes, only: layered_mesh_t
  use mean_stiffnesses, only: in_bending
  use mesh_parameters, only: image_signs
  use ply_blocks, only: are_alike
  use ply_stacks, only: ply_stack_t
  use roundings, only: rounding
  use setups, only: setup_t
  use stacking, only: section_of, section_t, stacked_plies
  implicit none
  private
  public :: layup_t

  !> Laminates and stacks of plies.
  type :: layup_t
    !> Number of plies, those of doublers included
    integer :: plies = 0
    !> Each ply, and those at the images of its place by the plate's symmetry, (plies, parts of the plate)
    integer, allocatable :: images(:, :)
    !> Thickness of the laminate
    real(wp) :: thickness = 0
    !> The different laminates of the plate, the skin's first
    type(ply_stack_t), allocatable :: laminates(:)
    !> Section of the full laminate; that at the struck point about the middle of all plies there, with the bending
    !> moduli of plies with E1c
    type(section_t) :: section, bending_section
    !> Plies at the struck point
    type(ply_stack_t) :: struck
    !> Their thickness
    real(wp) :: struck_thickness = 0
    !> The different stacks of elements, one for each layer of the mesh
    type(ply_stack_t), allocatable :: stacks(:)
    !> Stack of each of this rank's elements, (elements)
    integer, allocatable :: stack(:)
    !> Resultants of the thermal strains of undamaged plies, and their energy per area, (lanes, 7, batches); allocated
    !> only if they are modelled
    real(wp), allocatable :: free(:, :, :)
  contains
    procedure :: find_laminates
    procedure :: of_full_plate
    procedure :: are_alike => have_same_plies
    procedure :: are_images
    procedure :: assign_stacks
  end type layup_t

contains

  !> Finds the different laminates of the plate, and that of each cell.
  pure subroutine find_laminates(self, setup, laminate_of)
    class(layup_t), intent(inout) :: self
    type(setup_t), intent(in) :: setup
    !> Number of that of each cell, columns first
    integer, allocatable, intent(out) :: laminate_of(:)
    type(cell_line_t) :: columns, rows
    type(laminate_t) :: local
    integer :: i, j

    self%plies = setup%plies()
    call find_images(self, setup)
    self%thickness = sum(setup%laminate%thickness)
    columns = cells_along(setup%plate, setup%mesh, 1)
    rows = cells_along(setup%plate, setup%mesh, 2)
    associate (x => columns%middles(), y => rows%middles())
      call setup%zones%find_stacks(setup%laminate, setup%materials, &
                                   reshape([(([x(i), y(j)], i=1, size(x)), j=1, size(y))], [2, size(x)*size(y)]), &
                                   self%laminates, laminate_of)
    end associate
    if (setup%thermal%is_present) then
      do i = 1, size(self%laminates)
        call self%laminates(i)%set_thermal_strains(setup%materials, setup%thermal%temperature_change)
      end do
    end if
    self%section = section_of(self%laminates(1)%plies, setup%laminate%shear_correction)
    self%struck = setup%struck_stack()
    local = setup%struck_laminate()
    self%struck_thickness = sum(local%thickness)
    self%bending_section = section_of(in_bending(stacked_plies(local, setup%materials)), local%shear_correction)
  end subroutine find_laminates

  !> Finds the images of each ply.
  pure subroutine find_images(self, setup)
    type(layup_t), intent(inout) :: self
    type(setup_t), intent(in) :: setup
    integer, allocatable :: signs(:, :)
    integer :: i

    signs = image_signs(setup%plate%symmetry)
    allocate (self%images(self%plies, size(signs, 2) + 1))
    self%images(:, 1) = [(i, i=1, self%plies)]
    do i = 1, size(signs, 2)
      self%images(:, i + 1) = setup%zones%images(size(setup%laminate%material), signs(:, i), &
                                                 rounding*maxval(setup%plate%length))
    end do
  end subroutine find_images

  !> Quantities of the plies in the full plate: the sums over their images in the modelled part.
  pure function of_full_plate(self, modelled) result(full)
    class(layup_t), intent(in) :: self
    !> Those of the modelled part, (plies)
    real(wp), intent(in) :: modelled(:)
    real(wp) :: full(size(modelled))
    integer :: ply

    full = [(sum(modelled(self%images(ply, :))), ply=1, size(full))]
  end function of_full_plate

  !> True if two laminates have plies of the same materials and angles at the same heights.
  pure logical function have_same_plies(self, a, b) result(same)
    class(layup_t), intent(in) :: self
    !> The laminates
    integer, intent(in) :: a, b
    integer :: i

    associate (mine => self%laminates(a)%plies, its => self%laminates(b)%plies)
      same = size(mine) == size(its)
      if (.not. same) return
      same = all([(are_alike(mine(i), its(i)), i=1, size(mine))]) .and. &
             all(abs([mine%z_top - its%z_top, mine%z_bottom - its%z_bottom]) <= rounding*self%thickness)
    end associate
  end function have_same_plies

  !> True if each ply of a laminate is that of another with as many plies, or the image of it.
  pure logical function are_images(self, a, b)
    class(layup_t), intent(in) :: self
    !> The laminates
    integer, intent(in) :: a, b

    are_images = all(minval(self%images(self%laminates(a)%number, :), 2) &
                     == minval(self%images(self%laminates(b)%number, :), 2))
  end function are_images

  !> Finds the stack of each layer of the mesh and of each of this rank's elements.
  pure subroutine assign_stacks(self, mesh, elements, has_free_strains)
    class(layup_t), intent(inout) :: self
    type(layered_mesh_t), intent(in) :: mesh
    !> Elements of this rank
    integer, intent(in) :: elements(:)
    !> True: thermal strains are modelled
    logical, intent(in) :: has_free_strains
    integer :: i

    allocate (self%stacks(size(mesh%layers)))
    do i = 1, size(self%stacks)
      associate (layer => mesh%layers(i))
        self%stacks(i) = self%laminates(layer%laminate)%layer(layer%plies(1), layer%plies(2))
      end associate
    end do
    self%stack = mesh%element_layer(elements)
    if (.not. has_free_strains) return
    allocate (self%free(lanes, 7, (size(elements) + lanes - 1)/lanes), source=0.0_wp)
    do i = 1, size(elements)
      associate (plies => self%stacks(self%stack(i))%plies)
        self%free(lane_of(i), :, batch_of(i)) = free_resultants(plies, plies%elasticity)
      end associate
    end do
  end subroutine assign_stacks
end module layups
