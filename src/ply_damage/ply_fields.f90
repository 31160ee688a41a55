!> Fields of the plies: failures, and stresses in their own axes.
module ply_fields
  use crack_band_sections, only: crack_band_sections_t
  use element_stresses, only: element_strains, stresses_of_ply
  use errors, only: error_t
  use fields_file, only: fields_file_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use output_parameters, only: output_t, field_ply_damage, field_stress, field_face_stress
  use plies, only: elasticity_t
  use ply_damage_parameters, only: fibre_compression, fibre_tension
  use ply_failures, only: ply_failure_t
  use result_tables, only: result_row_length
  use text, only: to_text
  implicit none
  private
  public :: write_ply_fields

  !> Columns of a row between name and meaning: of stiffness lost, of stresses in the mid-plane of a ply and on its
  !> faces.
  character(len=*), parameter :: damaged = ' | cells | - | '//field_ply_damage//' | &ply_damage | '
  character(len=*), parameter :: middle = ' | cells | pressure | '//field_stress//' | - | ', &
                                 faces = ' | cells | pressure | '//field_face_stress//' | - | '
  !> The fields; N is the number of the ply from the struck face. Elements without ply N have 0.
  character(len=result_row_length), parameter, public :: ply_field_rows(*) = [character(len=result_row_length) :: &
    'ply_N_failure | cells | - | '//field_ply_damage//' | &ply_damage | Failures of ply N: 1 fibre failure, 2 matrix &
      &cracking, 4 matrix crushing, added up.', &
    'ply_N_fibres_crushed'//damaged//'1 where fibres of ply N have failed and dissipated more energy in compression &
      &than in tension, else 0; only where plies soften.', &
    'ply_N_damage_fibre'//damaged//'Relative loss of E1 of ply N, 0 to 1.', &
    'ply_N_damage_matrix'//damaged//'Relative loss of E2 of ply N, 0 to 1.', &
    'ply_N_fibre_strength | cells | pressure | '//field_ply_damage//' | &ply_damage | Tensile strength of the fibres &
      &of ply N that scatters from place to place; only with strength_seed.', &
    'ply_N_sigma11'//middle//'Stress along the fibres in the mid-plane of ply N.', &
    'ply_N_sigma22'//middle//'Stress across the fibres in the mid-plane of ply N.', &
    'ply_N_tau12'//middle//'In-plane shear stress, in the mid-plane of ply N.', &
    'ply_N_tau13'//middle//'Transverse shear stress in the 1-3 plane, mean over ply N.', &
    'ply_N_tau23'//middle//'Transverse shear stress in the 2-3 plane, mean over ply N.', &
    'ply_N_sigma11_top'//faces//'Stress along the fibres on the upper face of ply N, towards the struck face.', &
    'ply_N_sigma22_top'//faces//'Stress across the fibres on the upper face of ply N.', &
    'ply_N_tau12_top'//faces//'In-plane shear stress on the upper face of ply N.', &
    'ply_N_sigma11_bottom'//faces//'Stress along the fibres on the lower face of ply N.', &
    'ply_N_sigma22_bottom'//faces//'Stress across the fibres on the lower face of ply N.', &
    'ply_N_tau12_bottom'//faces//'In-plane shear stress on the lower face of ply N.']

contains

  !> Writes the requested fields.
  subroutine write_ply_fields(plate, plies, displacement, output, fields, error)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: plies
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Requested fields
    type(output_t), intent(in) :: output
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=*), parameter :: components(5) = [character(len=7) :: 'sigma11', 'sigma22', 'tau12', 'tau13', 'tau23']
    character(len=*), parameter :: places(3) = [character(len=7) :: '', '_top', '_bottom']
    logical :: requested(3)
    real(wp), allocatable :: strains(:, :), stresses(:, :, :), lost(:, :)
    integer :: ply, place, i

    requested = [output%requests(field_stress), output%requests(field_face_stress), output%requests(field_face_stress)]
    if (any(requested)) strains = element_strains(plate, plies, displacement)
    do ply = 1, plate%layup%plies
      associate (name => 'ply_'//to_text(ply)//'_')
        if (output%requests(field_ply_damage) .and. plate%setup%ply_damage%is_present) then
          call fields%write_cell_field(name//'failure', failure_code(plies%failed_in_elements(plate, ply)), error)
          if (allocated(plies%bands)) &
            call fields%write_cell_field(name//'fibres_crushed', crushed_in(plate, plies%bands, ply), error)
          if (plate%setup%ply_damage%scatters()) &
            call fields%write_cell_field(name//'fibre_strength', strengths_in(plate, plies%bands, ply), error)
          lost = stiffness_lost(plate, plies, ply)
          call fields%write_cell_field(name//'damage_fibre', lost(1:1, :), error)
          call fields%write_cell_field(name//'damage_matrix', lost(2:2, :), error)
        end if
        if (any(requested)) stresses = stresses_of_ply(plate, plies, strains, ply)
        do place = 1, 3
          if (.not. requested(place)) cycle
          do i = 1, merge(5, 3, place == 1)
            call fields%write_cell_field(name//trim(components(i))//trim(places(place)), stresses(i:i, place, :), error)
          end do
        end do
      end associate
    end do
  end subroutine write_ply_fields

  !> 1 in elements in which the fibres of a ply have failed and dissipated more energy in compression than in tension,
  !> else 0.
  pure function crushed_in(plate, bands, ply) result(crushed)
    type(composite_plate_t), intent(in) :: plate
    !> Softening plies
    type(crack_band_sections_t), intent(in) :: bands
    integer, intent(in) :: ply
    !> (1, elements)
    real(wp) :: crushed(1, plate%elements%elements)
    integer :: element

    crushed = 0
    do element = 1, size(crushed, 2)
      if (.not. plate%layup%stacks(plate%layup%stack(element))%has(ply)) cycle
      associate (state => bands%states%trial(bands%states%at(ply, element)))
        if (state%damage(1) >= 1 .and. state%dissipated(fibre_compression) > state%dissipated(fibre_tension)) &
          crushed(1, element) = 1
      end associate
    end do
  end function crushed_in

  !> Tensile strength of the fibres of a ply in each element.
  pure function strengths_in(plate, bands, ply) result(strengths)
    type(composite_plate_t), intent(in) :: plate
    !> Softening plies
    type(crack_band_sections_t), intent(in) :: bands
    integer, intent(in) :: ply
    !> (1, elements)
    real(wp) :: strengths(1, plate%elements%elements)
    integer :: element, at

    strengths = 0
    do element = 1, size(strengths, 2)
      if (.not. plate%layup%stacks(plate%layup%stack(element))%has(ply)) cycle
      at = bands%states%at(ply, element)
      strengths(1, element) = bands%bands(at - bands%states%offset(element))%along(1)*bands%drawn%factor(at)
    end do
  end function strengths_in

  !> Lost fractions of E1 and E2 of a ply.
  pure function stiffness_lost(plate, plies, ply) result(lost)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: plies
    integer, intent(in) :: ply
    !> From 0 to 1, (2, elements)
    real(wp) :: lost(2, plate%elements%elements)
    type(elasticity_t) :: left
    integer :: element

    lost = 0
    do element = 1, size(lost, 2)
      ! Softening plies show the damage of the cell in all of its layers.
      associate (laminate => plate%layup%laminates(plate%mesh%layers(plate%layup%stack(element))%laminate))
        if (.not. laminate%has(ply)) cycle
        if (.not. (allocated(plies%bands) .or. plate%layup%stacks(plate%layup%stack(element))%has(ply))) cycle
        left = plies%elasticity(plate, ply, element)
        associate (whole => laminate%plies(laminate%place(ply))%elasticity)
          lost(:, element) = 1 - [left%e1, left%e2]/[whole%e1, whole%e2]
        end associate
      end associate
    end do
  end function stiffness_lost

  !> Sum of 1 for fibre failure, 2 for matrix cracking, 4 for crushing.
  pure function failure_code(failed) result(code)
    !> Failed modes of a ply, (3, elements)
    logical, intent(in) :: failed(:, :)
    !> The sum, (1, elements)
    real(wp) :: code(1, size(failed, 2))

    code(1, :) = merge(1, 0, failed(1, :)) + merge(2, 0, failed(2, :)) + merge(4, 0, failed(3, :))
  end function failure_code
end module ply_fields
