!> Tensile strength of fibres by their stressed volume or drawn by position: bounds of it in the plate of the deck, and
!> checks of its keys.
module deck_fibre_strengths
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, remark, report
  use kinds, only: wp
  use mesh_parameters, only: parts_of
  use deck_stacks, only: stacks_of
  use ply_blocks, only: blocks_of
  use ply_stacks, only: ply_stack_t
  use ply_damage_deck, only: key_seed, key_square, key_volume, key_weibull, ply_damage_group
  use short_numbers, only: short_text
  use stressed_volumes, only: factor_of
  use text, only: to_text
  implicit none
  private
  public :: check_fibre_strengths, fibre_factors, block_volumes, scatter_of

  !> Message on keys of plies that soften.
  character(len=*), parameter, public :: belongs_to_softening = &
    'belongs to plies with fracture energies; give G_ft, G_fc, G_mt and G_mc of every material, or leave it out.'
  !> Ratios of the reference volume to that of the plate beyond which it is probably in another unit: specimens have 1
  !> to 1e5 mm3, plates 1e3 to 1e8 mm3, and metres in place of millimetres change the ratio by 1e9.
  real(wp), parameter :: usual_ratios(2) = [1.0e-8_wp, 1.0e3_wp]
  !> Most squares of all plies: a small part of the 2^32 random numbers of a seed, drawn within seconds.
  real(wp), parameter :: max_squares = 1.0e8_wp

contains

  !> Checks the keys of plies with fracture energies, or without.
  subroutine check_fibre_strengths(deck, softens, problems)
    type(deck_t), intent(in) :: deck
    !> True: plies soften by their fracture energies
    logical, intent(in) :: softens
    type(problems_t), intent(inout) :: problems

    associate (s => deck%settings, damage => deck%setup%ply_damage)
      if (.not. damage%weibull_modulus > 0) return
      if (.not. softens) then
        call report(s, problems, ply_damage_group, key_weibull, belongs_to_softening)
      else if (.not. damage%reference_volume > 0) then
        if (are_clear(s, problems, ply_damage_group, key_volume)) &
          call report(s, problems, ply_damage_group, key_weibull, 'needs '//key_volume//', the stressed volume of '// &
                      'the specimens that XT was measured on; give it, or units of &case for its default of 3750 mm3.')
      else if (allocated(deck%setup%laminate%thickness)) then
        associate (ratio => damage%reference_volume &
                            /(product(deck%setup%plate%length)*sum(deck%setup%laminate%thickness)))
          if (ratio < usual_ratios(1) .or. ratio > usual_ratios(2)) &
            call remark(s, problems, ply_damage_group, key_volume, 'is '//short_text(ratio)//' times the volume of '// &
                        'the plate; it is probably in another unit than the lengths of the plate.')
        end associate
      end if
    end associate
    if (softens .and. deck%setup%ply_damage%scatters()) call check_squares(deck, problems)
  end subroutine check_fibre_strengths

  !> Checks the squares of strengths drawn by position.
  subroutine check_squares(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: squares

    associate (s => deck%settings, side => deck%setup%ply_damage%strength_length)
      if (.not. are_clear(s, problems, ply_damage_group, key_square)) return
      if (.not. side > 0) then
        call report(s, problems, ply_damage_group, key_seed, 'needs '//key_square//', the side of the squares of a '// &
                    'ply within which its strength is uniform; give it, or units of &case for its default of 1 mm.')
      else if (allocated(deck%setup%laminate%thickness)) then
        squares = product(deck%setup%plate%length/side)*deck%setup%plies()
        if (squares > max_squares) call report(s, problems, ply_damage_group, key_square, 'makes '// &
          short_text(squares)//' squares of all plies; allowed: at most '//to_text(max_squares)//'.')
      end if
    end associate
  end subroutine check_squares

  !> Bounds of the stressed volume of the blocks of a material: that of its thinnest block in the smallest cell, and
  !> that of its thickest block in the plate. Strengths drawn by position are those of plies instead of blocks, and of
  !> squares at least.
  pure function block_volumes(deck, place) result(volumes)
    type(deck_t), intent(in) :: deck
    !> Index of the material, the first of equal ones
    integer, intent(in) :: place
    !> Smallest and largest; 0: no ply is of this material
    real(wp) :: volumes(2)
    type(ply_stack_t), allocatable :: stacks(:)
    type(cell_line_t) :: columns, rows
    real(wp), allocatable :: thicknesses(:)
    integer :: i

    stacks = stacks_of(deck%setup)
    if (deck%setup%ply_damage%scatters()) then
      thicknesses = [(pack(stacks(i)%plies%z_bottom - stacks(i)%plies%z_top, stacks(i)%plies%material == place), &
                      i=1, size(stacks))]
    else
      thicknesses = [(blocks_of(stacks(i)%plies, place), i=1, size(stacks))]
    end if
    volumes = 0
    if (size(thicknesses) == 0) return
    columns = cells_along(deck%setup%plate, deck%setup%mesh, 1)
    rows = cells_along(deck%setup%plate, deck%setup%mesh, 2)
    volumes(1) = minval(thicknesses)*max(deck%setup%ply_damage%strength_length**2, &
      minval(columns%sides())*minval(rows%sides())*parts_of(deck%setup%plate%symmetry))
    volumes(2) = maxval(thicknesses)*product(deck%setup%plate%length)
  end function block_volumes

  !> Largest and smallest tensile strength of the fibres of a material over XT.
  pure function fibre_factors(deck, place) result(factors)
    type(deck_t), intent(in) :: deck
    !> Index of the material, the first of equal ones
    integer, intent(in) :: place
    !> Where the smallest and where the largest volume is stressed
    real(wp) :: factors(2)
    real(wp) :: volumes(2)

    factors = 1
    volumes = block_volumes(deck, place)
    if (.not. deck%setup%ply_damage%weibull_modulus > 0 .or. .not. all(volumes > 0)) return
    factors = [factor_of(deck%setup%ply_damage, volumes(1)), factor_of(deck%setup%ply_damage, volumes(2))]
  end function fibre_factors

  !> Coefficient of variation of strengths drawn by position, of squares and of larger volumes alike: that of Weibull's
  !> distribution, about 1.2/m.
  pure real(wp) function scatter_of(modulus) result(scatter)
    !> Weibull modulus m
    real(wp), intent(in) :: modulus

    scatter = sqrt(gamma(1 + 2/modulus)/gamma(1 + 1/modulus)**2 - 1)
  end function scatter_of
end module deck_fibre_strengths
