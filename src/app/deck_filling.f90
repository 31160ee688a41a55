!> Fills the parameters that live beside the physics from the keys in effect. Checks nothing.
module deck_filling
  use deck_contents, only: deck_t
  use pressure_loads, only: history_step, history_ramp, distribution_uniform, distribution_sine
  use stepping_parameters, only: integrator_newmark, integrator_generalized_alpha, refactor_deflection, refactor_iterations
  use linear_solver_parameters, only: factorization_mumps, factorization_cholmod
  use impact_parameters, only: integrator_gear4, integrator_trapezoidal, integrator_central, integrator_conserving, &
                               law_tan_sun, law_hertz, dent_tan_sun, dent_yang_sun
  use kinds, only: wp
  use material_parameters, only: material_t
  use mesh_parameters, only: edge_free, edge_simple, edge_clamped, symmetry_none, symmetry_quarter
  use plate_options, only: kinematics_linear, kinematics_von_karman, shear_assumed, shear_full, shear_selective, &
                           mass_consistent, mass_lumped
  use text, only: line_t, lower_case, to_text, words_of
  implicit none
  private
  public :: fill_case, fill_plate, fill_loads, fill_control, code_of

contains

  !> Number that stands for a choice; the first one if the word is none of them.
  pure integer function code_of(word, names, codes) result(code)
    !> The choice
    character(len=*), intent(in) :: word
    !> Choices separated by blanks
    character(len=*), intent(in) :: names
    !> Their numbers
    integer, intent(in) :: codes(:)
    type(line_t), allocatable :: choices(:)
    integer :: i

    choices = words_of(names, ' ')
    code = codes(1)
    do i = 1, size(choices)
      if (choices(i)%text == lower_case(word)) code = codes(i)
    end do
  end function code_of

  !> Name, title and strains.
  subroutine fill_case(deck)
    !> Receives them
    type(deck_t), intent(inout) :: deck

    if (.not. deck%settings%is_known('case', 'name')) then
      call deck%settings%derive('case', 'name', name_from(deck%source), .true.)
    end if
    deck%name = deck%settings%text_of('case', 'name')
    deck%title = deck%settings%text_of('case', 'title')
    deck%kinematics = code_of(deck%settings%text_of('case', 'kinematics'), 'von_karman linear', &
                              [kinematics_von_karman, kinematics_linear])
  end subroutine fill_case

  !> File name of a path without folders and extension; characters that a case name can't have become _.
  pure function name_from(path) result(name)
    !> The path
    character(len=*), intent(in) :: path
    !> Name of the case
    character(len=:), allocatable :: name
    integer :: i

    name = path(index(path, '/', back=.true.) + 1:)
    if (index(name, '.', back=.true.) > 1) name = name(:index(name, '.', back=.true.) - 1)
    name = name(:min(len(name), 80))
    do i = 1, len(name)
      if (verify(lower_case(name(i:i)), 'abcdefghijklmnopqrstuvwxyz0123456789._-') > 0) name(i:i) = '_'
    end do
    if (verify(name(:min(1, len(name))), '._-') == 0) name = 'case'//name
  end function name_from

  !> Plate and mesh.
  subroutine fill_plate(deck)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    type(line_t), allocatable :: edges(:)
    integer :: i

    associate (s => deck%settings, plate => deck%plate, mesh => deck%mesh)
      if (s%is_known('plate', 'length')) plate%length = s%reals_of('plate', 'length')
      edges = s%texts_of('plate', 'edges')
      do i = 1, merge(4, 0, size(edges) > 0)
        plate%edges(i) = code_of(edges(min(i, size(edges)))%text, 'free simple clamped', &
                                 [edge_free, edge_simple, edge_clamped])
      end do
      plate%in_plane_fixed = lower_case(s%text_of('plate', 'in_plane')) /= 'free'
      plate%symmetry = code_of(s%text_of('plate', 'symmetry'), 'none quarter', [symmetry_none, symmetry_quarter])
      if (s%is_known('mesh', 'elements')) mesh%elements = s%integers_of('mesh', 'elements')
      mesh%grading = s%real_of('mesh', 'grading')
      mesh%patch = s%real_of('mesh', 'patch')
      if (s%is_given('mesh', 'core')) mesh%core = s%reals_of('mesh', 'core')
      if (s%is_given('mesh', 'cell')) mesh%cell = s%real_of('mesh', 'cell')
      mesh%shear = code_of(s%text_of('mesh', 'shear'), 'assumed full selective', &
                           [shear_assumed, shear_full, shear_selective])
      mesh%mass = code_of(s%text_of('mesh', 'mass'), 'consistent lumped', [mass_consistent, mass_lumped])
    end associate
  end subroutine fill_plate

  !> Impactor, indentation, pressure and load steps, as far as the deck has them.
  subroutine fill_loads(deck)
    !> Receives them
    type(deck_t), intent(inout) :: deck

    associate (s => deck%settings)
      deck%has_impactor = s%has_group('impactor')
      deck%has_indentation = s%has_group('indentation')
      deck%has_pressure = s%has_group('pressure')
      deck%has_static = s%has_group('static')
      deck%impactor%mass = s%real_of('impactor', 'mass')
      deck%impactor%velocity = s%real_of('impactor', 'velocity')
      deck%impactor%radius = s%real_of('impactor', 'radius')
      deck%impactor%gravity = s%real_of('impactor', 'gravity')
      deck%impactor%integrator = code_of(s%text_of('impactor', 'integrator'), 'gear4 trapezoidal central conserving', &
        [integrator_gear4, integrator_trapezoidal, integrator_central, integrator_conserving])
      deck%pressure%value = s%real_of('pressure', 'value')
      deck%pressure%history = code_of(s%text_of('pressure', 'history'), 'step ramp', [history_step, history_ramp])
      deck%pressure%distribution = code_of(s%text_of('pressure', 'distribution'), 'uniform sine', &
                                           [distribution_uniform, distribution_sine])
      if (deck%has_static) deck%stepping%static_steps = s%integer_of('static', 'steps')
    end associate
    if (deck%has_impactor) call fill_indentation(deck)
  end subroutine fill_loads

  !> Indentation law and contact stiffness.
  subroutine fill_indentation(deck)
    !> Receives them
    type(deck_t), intent(inout) :: deck

    associate (s => deck%settings, law => deck%indentation)
      law%law = law_hertz
      if (deck%has_indentation) then
        law%law = code_of(s%text_of('indentation', 'law'), 'tan_sun hertz', [law_tan_sun, law_hertz])
        law%dent = code_of(s%text_of('indentation', 'dent'), 'tan_sun yang_sun', [dent_tan_sun, dent_yang_sun])
        law%q = s%real_of('indentation', 'q')
        law%reload = s%real_of('indentation', 'reload')
        law%beta = s%real_of('indentation', 'beta')
        law%alpha_critical = s%real_of('indentation', 'alpha_cr')
      end if
      law%k = s%real_of('indentation', 'k')
      if (s%is_given('indentation', 'k') .or. .not. allocated(deck%laminate%material)) return
      law%k = sun_stiffness(deck)
      call s%derive('indentation', 'k', to_text(law%k), .false.)
    end associate
  end subroutine fill_indentation

  !> Contact stiffness of a sphere on the struck ply: k = 4/3 sqrt(R) / ((1 - nu_s**2)/E_s + 1/E2) (Sun and Yang);
  !> on an isotropic plate Hertz' (1 - nu**2)/E stands for 1/E2.
  pure real(wp) function sun_stiffness(deck) result(k)
    !> The deck with its laminate
    type(deck_t), intent(in) :: deck
    type(material_t) :: struck
    real(wp) :: compliance

    struck = deck%materials(deck%laminate%material(1))
    k = 0
    if (struck%e2 <= 0) return
    compliance = 1/struck%e2
    if (deck%settings%is_given('material', 'E', deck%laminate%material(1))) compliance = (1 - struck%nu12**2)/struck%e2
    if (deck%settings%is_known('indentation', 'impactor_E')) compliance = compliance + &
      (1 - deck%settings%real_of('indentation', 'impactor_nu')**2)/deck%settings%real_of('indentation', 'impactor_E')
    k = 4*sqrt(deck%impactor%radius)/(3*compliance)
  end function sun_stiffness

  !> Time, adaptivity and solver.
  subroutine fill_control(deck)
    !> Receives them
    type(deck_t), intent(inout) :: deck

    deck%has_time = deck%settings%has_group('time')
    if (deck%has_time) call fill_time(deck)
    deck%pressure%ramp_time = deck%stepping%time%end
    associate (s => deck%settings, adapt => deck%stepping%adapt, equilibrium => deck%stepping%equilibrium, &
               solver => deck%linear_solver)
      deck%has_adapt = s%has_group('adapt')
      if (.not. deck%has_adapt) call s%derive('adapt', 'on', '.false.', .false.)
      adapt%on = s%logical_of('adapt', 'on')
      adapt%refactor = code_of(s%text_of('adapt', 'refactor'), 'deflection iterations', &
                               [refactor_deflection, refactor_iterations])
      adapt%stiffness_update = s%real_of('adapt', 'stiffness_update')
      adapt%stress_change = s%real_of('adapt', 'stress_change')
      adapt%iterations = s%integer_of('adapt', 'iterations')
      adapt%growth_step = s%real_of('adapt', 'growth_step')
      equilibrium%tolerance = s%real_of('solver', 'tolerance')
      equilibrium%max_iterations = s%integer_of('solver', 'max_iterations')
      solver%factorization = code_of(s%text_of('solver', 'factorization'), 'mumps cholmod', &
                                     [factorization_mumps, factorization_cholmod])
      solver%petsc_options = s%text_of('solver', 'petsc_options')
    end associate
  end subroutine fill_control

  !> Time integration of the plate.
  subroutine fill_time(deck)
    !> Receives it
    type(deck_t), intent(inout) :: deck

    associate (s => deck%settings, time => deck%stepping%time)
      time%end = s%real_of('time', 'end')
      time%step = s%real_of('time', 'step')
      if (.not. s%is_given('time', 'step_min')) call s%derive('time', 'step_min', to_text(time%step/1024), .false.)
      if (.not. s%is_given('time', 'step_max')) call s%derive('time', 'step_max', to_text(time%step), .false.)
      time%step_min = s%real_of('time', 'step_min')
      time%step_max = s%real_of('time', 'step_max')
      time%wall_limit = s%real_of('time', 'wall_limit')
      time%integrator = code_of(s%text_of('time', 'integrator'), 'newmark generalized_alpha', &
                                [integrator_newmark, integrator_generalized_alpha])
      time%beta = s%real_of('time', 'beta')
      time%gamma = s%real_of('time', 'gamma')
      if (.not. s%is_given('time', 'rho_inf')) &
        call s%derive('time', 'rho_inf', merge('0', '1', s%has_group('delamination')), .false.)
      time%rho_infinity = s%real_of('time', 'rho_inf')
    end associate
  end subroutine fill_time
end module deck_filling
