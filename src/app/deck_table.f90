!> The one table of the deck: every group and key with its type, count, unit, default, range and meaning.
!> The scan, the checks, the echo, `implam explain` and the manual are all made from it.
module deck_table
  use deck_vocabulary, only: vocabulary_t, load_vocabulary
  implicit none
  private
  public :: load_deck_table

  !> A column ends with a bar. Groups: name, presence (required, repeatable = required and may come again,
  !> settings = in effect even if left out, optional = physics that is only modelled if the group is there, several =
  !> optional and may come again), meaning.
  character(len=*), parameter :: group_rows(*) = [character(len=220) :: &
    'case | settings | The case: its name, its title and the strains used.', &
    'plate | required | The plate: size, supports and the part of it that is modelled.', &
    'mesh | required | The rectangle of nine-node elements and the loaded patch.', &
    'material | repeatable | One ply material, orthotropic or isotropic; may be given several times.', &
    'laminate | required | The plies, from the struck face to the back.', &
    'impactor | optional | The rigid impactor that strikes the middle of the plate.', &
    'indentation | optional | Contact force against indentation; left out: elastic Hertz, k by Sun''s formula.', &
    'pressure | optional | Pressure on the struck face.', &
    'static | optional | Load steps in equilibrium instead of time; takes the pressure as load.', &
    'ply_damage | optional | Failure of plies: matrix cracking, matrix crushing, fibre failure.', &
    'delamination | several | An interface that may delaminate; one group an interface.', &
    'time | optional | Time integration of the plate; needed unless the analysis is static.', &
    'adapt | settings | Adaptive time step and the rule for renewing the factored stiffness.', &
    'solver | settings | Convergence of equilibrium and linear algebra.', &
    'output | settings | What is written, how often and where.']

  !> Columns: group, key, type, number of values, unit, default, allowed, meaning. A default that begins
  !> with = is worked out from other values; `none` means that the key may be left out.
  character(len=*), parameter :: key_rows(*) = [character(len=240) :: &
    'case | name | name | 1 | - | = the deck''s file name | letters, digits, . _ - | &
      &Names the output files.', &
    'case | title | text | 1 | - | '''' | any text | &
      &Free text kept with the results.', &
    'case | kinematics | choice | 1 | - | ''von_karman'' | von_karman linear | &
      &Strains: with the squares of the slopes (large deflection), or linear.', &
    'plate | length | real | 2 | length | required | > 0 | &
      &Lengths of the whole plate along x and y, also under symmetry.', &
    'plate | edges | choice | 1 or 4 | - | required | clamped simple free | &
      &Supports at x-min, x-max, y-min, y-max; one value serves all.', &
    'plate | in_plane | choice | 1 | - | ''fixed'' | fixed free | &
      &Whether the supported edges also hold the plate in its plane.', &
    'plate | symmetry | choice | 1 | - | ''none'' | none quarter | &
      &Part that is modelled: all, or the quarter x >= 0, y >= 0.', &
    'mesh | elements | integer | 2 | - | required | >= 2, <= 2000 | &
      &Elements along x and y of the modelled part.', &
    'mesh | grading | real | 1 | - | 0 | >= 0, <= 1000 | &
      &Largest over smallest element edge outside the patch; 0: sizes change smoothly.', &
    'mesh | patch | real | 1 | length | 0 | >= 0 | &
      &Side of the loaded square centred on the struck point; an impactor needs one.', &
    'mesh | core | real | 2 | length | none | > 0 | &
      &Full extents of a rectangle of equal elements around the struck point; given with `cell`.', &
    'mesh | cell | real | 1 | length | none | > 0 | &
      &Side of the elements in the core; outside sizes grow smoothly or by `grading`.', &
    'mesh | shear | choice | 1 | - | ''assumed'' | assumed full selective | &
      &Transverse shear of the element: assumed strains, 3 x 3 or 2 x 2 integration.', &
    'mesh | mass | choice | 1 | - | ''consistent'' | consistent lumped | &
      &Mass matrix of the plate.', &
    'material | name | text | 1 | - | required | not empty | &
      &Name that &laminate refers to.', &
    'material | density | real | 1 | mass/volume | none | > 0 | &
      &Mass per volume; needed unless the analysis is static.', &
    'material | E | real | 1 | pressure | none | > 0 | &
      &Young''s modulus of an isotropic material, given with nu instead of E1 to nu23.', &
    'material | nu | real | 1 | - | none | > -1, < 0.5 | &
      &Poisson''s ratio of an isotropic material.', &
    'material | E1 | real | 1 | pressure | none | > 0 | &
      &Young''s modulus along the fibres.', &
    'material | E2 | real | 1 | pressure | none | > 0 | &
      &Young''s modulus across the fibres.', &
    'material | G12 | real | 1 | pressure | none | > 0 | &
      &Shear modulus in the plane of the ply.', &
    'material | G13 | real | 1 | pressure | = G12 | > 0 | &
      &Shear modulus between the fibres and the normal.', &
    'material | G23 | real | 1 | pressure | none | > 0 | &
      &Shear modulus across the fibres.', &
    'material | nu12 | real | 1 | - | none | > -10, < 10 | &
      &Contraction across per extension along the fibres; its size stays below sqrt(E1/E2).', &
    'material | nu23 | real | 1 | - | 0 | > -1, < 1 | &
      &Poisson''s ratio across the fibres; plane stress does without it.', &
    'material | XT | real | 1 | pressure | none | > 0 | &
      &Tensile strength along the fibres.', &
    'material | XC | real | 1 | pressure | none | > 0 | &
      &Compressive strength along the fibres, a positive number; left out: XT serves.', &
    'material | YT | real | 1 | pressure | none | > 0 | &
      &Tensile strength across the fibres.', &
    'material | YC | real | 1 | pressure | none | > 0 | &
      &Compressive strength across the fibres, a positive number.', &
    'material | S12 | real | 1 | pressure | none | > 0 | &
      &Shear strength in the plane of the ply.', &
    'material | Sf | real | 1 | pressure | none | > 0 | &
      &Shear strength that counts in fibre failure.', &
    'material | Sm23 | real | 1 | pressure | none | > 0 | &
      &Shear strength in the 2-3 plane that counts in matrix failure.', &
    'laminate | materials | text | 1 or plies | - | required | names of &material groups | &
      &Material of each ply from the struck face; one value serves all.', &
    'laminate | angles | real | plies | degree | required | >= -360, <= 360 | &
      &Fibre angle of each ply from x; their number is the number of plies.', &
    'laminate | thicknesses | real | 1 or plies | length | required | > 0 | &
      &Thickness of each ply; one value serves all.', &
    'laminate | shear_correction | choice | 1 | - | ''5/6'' | 5/6 energy | &
      &Reduction of the transverse shear stiffness: a factor, or equal shear energy.', &
    'impactor | mass | real | 1 | mass | required | > 0 | &
      &Mass of the whole impactor, also under symmetry.', &
    'impactor | velocity | real | 1 | length/time | required | >= 0 | &
      &Speed towards the plate at first touch.', &
    'impactor | radius | real | 1 | length | none | > 0 | &
      &Radius of the nose; needed if the contact stiffness k isn''t given.', &
    'impactor | gravity | real | 1 | length/time^2 | 0 | any | &
      &Acceleration of gravity along the impact, positive towards the plate.', &
    'impactor | integrator | choice | 1 | - | ''gear4'' | gear4 trapezoidal central conserving | &
      &Time integrator of the impactor.', &
    'indentation | law | choice | 1 | - | ''tan_sun'' | tan_sun hertz | &
      &Loading, unloading and reloading after Tan and Sun, or elastic Hertz both ways.', &
    'indentation | k | real | 1 | force/length^1.5 | = Sun''s formula | > 0 | &
      &Contact stiffness in F = k alpha^1.5.', &
    'indentation | impactor_E | real | 1 | pressure | = rigid | > 0 | &
      &Young''s modulus of the impactor in Sun''s formula for k.', &
    'indentation | impactor_nu | real | 1 | - | 0.3 | > -1, < 0.5 | &
      &Poisson''s ratio of the impactor in Sun''s formula for k.', &
    'indentation | q | real | 1 | - | 2.5 | >= 1, <= 10 | &
      &Exponent of unloading.', &
    'indentation | reload | real | 1 | - | 1.5 | >= 1, <= 10 | &
      &Exponent of reloading after faces.', &
    'indentation | beta | real | 1 | - | 0.094 | >= 0, < 1 | &
      &Slope of Tan and Sun''s dent.', &
    'indentation | alpha_cr | real | 1 | length | none | > 0 | &
      &Indentation above which a dent remains; needed with law = ''tan_sun''.', &
    'indentation | dent | choice | 1 | - | ''tan_sun'' | tan_sun yang_sun | &
      &Formula of the permanent dent.', &
    'pressure | value | real | 1 | pressure | required | any | &
      &Force per area, positive downwards.', &
    'pressure | history | choice | 1 | - | ''step'' | step ramp | &
      &There from the start, or growing in proportion to time up to the end.', &
    'pressure | distribution | choice | 1 | - | ''uniform'' | uniform sine | &
      &Uniform, or one half-sine along each side.', &
    'static | steps | integer | 1 | - | 1 | >= 1, <= 100000 | &
      &Equal steps in which the load is put on.', &
    'ply_damage | d | real | 1 | - | 100 | >= 1 | &
      &Divisor of the elastic constants that a mode of failure takes away (Table 2).', &
    'ply_damage | e | real | 1 | - | 0.001 | > 0, <= 1 | &
      &Least value left of an elastic constant, as a fraction of the undamaged one.', &
    'ply_damage | fade | real | 1 | time | 0 | >= 0 | &
      &Time over which a failure takes its stiffness away, in proportion; 0: at once.', &
    'ply_damage | average | real | 1 | length | 0 | >= 0 | &
      &Distance over which the strains for the criteria are averaged; 0: over each element alone.', &
    'ply_damage | criteria | choice | 1 | - | ''hou'' | hou | &
      &Set of failure criteria: those of Hou et al. (Table 1).', &
    'ply_damage | stress | choice | 1 | - | ''middle'' | middle faces | &
      &Where in a ply the stresses are taken: its mid-plane, or the worse of its faces.', &
    'delamination | below_ply | integer | 1 | - | required | >= 1, <= 1000 | &
      &The interface lies below this ply, counted from the struck face.', &
    'delamination | G_c | real | 1 | energy/area | none | > 0 | &
      &Critical energy release rate of every mode; given instead of G_Ic and G_IIc.', &
    'delamination | G_Ic | real | 1 | energy/area | none | > 0 | &
      &Critical energy release rate of pure opening.', &
    'delamination | G_IIc | real | 1 | energy/area | none | > 0 | &
      &Critical energy release rate of pure shear.', &
    'delamination | eta | real | 1 | - | 1.75 | > 0, <= 10 | &
      &Exponent of Benzeggagh and Kenane between opening and shear.', &
    'delamination | zone | real | 2 | length | required | > 0 | &
      &Full extents of the layered rectangle along x and y, centred on the struck point.', &
    'delamination | starter | real | 1 | length | = 0.05 % of the plate | > 0 | &
      &Side of the square starter delamination, centred on the struck point.', &
    'delamination | energy_release | choice | 1 | - | ''vcct'' | two_state vcct | &
      &Energy release rate: Eq. 11 with its sign put right, or virtual crack closure.', &
    'delamination | growth | choice | 1 | - | ''equilibrium'' | equilibrium one_per_step | &
      &Release at a frozen time until no front is above G_c, or one cell a step.', &
    'delamination | tie | choice | 1 | - | ''eliminate'' | eliminate penalty | &
      &Intact faces: exactly joined, or by penalty springs as in the paper.', &
    'delamination | penalty | real | 1 | pressure/length | = from E2 | > 0 | &
      &Stiffness of penalty ties; left out: a million times E2 over the thinner layer.', &
    'delamination | contact | choice | 1 | - | ''augmented_lagrangian'' | &
      &augmented_lagrangian continuous_penalty none | Contact of separated faces.', &
    'delamination | contact_exponent | real | 1 | - | 1 | >= 1, <= 2 | &
      &Exponent q of the continuous penalty (Eq. 12).', &
    'delamination | unloading | choice | 1 | - | ''contact'' | contact glued | &
      &While the impactor rebounds: real contact, or separated faces move together (Eq. 13b).', &
    'delamination | account | choice | 1 | - | ''debts'' | debts balance | &
      &Energy owed raises what the next cell must offer; with balance, energy in excess lowers it.', &
    'time | end | real | 1 | time | required | > 0 | &
      &End of the run.', &
    'time | step | real | 1 | time | required | > 0 | &
      &First time step, and the step if it doesn''t adapt.', &
    'time | step_min | real | 1 | time | = step/1024 | > 0 | &
      &Smallest step tried before giving up.', &
    'time | step_max | real | 1 | time | = step | > 0 | &
      &Largest step taken.', &
    'time | wall_limit | real | 1 | s | none | > 0 | &
      &Seconds on the wall by which the run ends with a checkpoint; --wall-limit overrides it.', &
    'time | integrator | choice | 1 | - | ''generalized_alpha'' | newmark generalized_alpha | &
      &Time integrator of the plate.', &
    'time | beta | real | 1 | - | 0.25 | > 0, <= 1 | &
      &Newmark''s beta; 2 beta >= gamma keeps every step stable.', &
    'time | gamma | real | 1 | - | 0.5 | >= 0.5, <= 1 | &
      &Newmark''s gamma; above 0.5 it damps.', &
    'time | rho_inf | real | 1 | - | = 1, with &delamination 0 | >= 0, <= 1 | &
      &Generalised-alpha''s spectral radius at high frequency: 1 damps nothing, 0 most.', &
    'adapt | on | logical | 1 | - | .true. | .true. .false. | &
      &Whether the time step follows the stress rate at the struck point; left-out group: .false.', &
    'adapt | refactor | choice | 1 | - | ''iterations'' | deflection iterations | &
      &What renews the factored stiffness: the deflection''s growth, or slow convergence.', &
    'adapt | stiffness_update | real | 1 | - | 0.003 | > 0, <= 10 | &
      &Growth of the struck point''s deflection that renews it, as a fraction of the thickness.', &
    'adapt | stress_change | real | 1 | - | 0.05 | > 0, <= 1 | &
      &Change of the struck point''s stress wanted in a step, as a fraction of its largest so far.', &
    'adapt | iterations | integer | 1 | - | 16 | >= 1, <= 1000 | &
      &Iterations lost to an old factored stiffness that pay for a new one.', &
    'adapt | growth_step | real | 1 | - | 0.25 | > 0, <= 1 | &
      &Smallest part of a step to which growth = ''one_per_step'' shortens it; 1: not at all.', &
    'solver | tolerance | real | 1 | - | 1e-6 | >= 1e-13, <= 0.01 | &
      &Residual of equilibrium accepted, relative to the forces in play.', &
    'solver | max_iterations | integer | 1 | - | 30 | >= 1, <= 10000 | &
      &Iterations before a step is tried again with half its length.', &
    'solver | factorization | choice | 1 | - | ''mumps'' | mumps cholmod | &
      &Direct solver; cholmod on one rank only.', &
    'solver | petsc_options | text | 1 | - | '''' | any text | &
      &Options handed to PETSc as they are.', &
    'output | directory | text | 1 | - | ''.'' | not empty | &
      &Folder of the results, made if it isn''t there; --output overrides it.', &
    'output | history_every | real | 1 | time | 0 | >= 0 | &
      &Time between rows of the history; 0: every accepted step.', &
    'output | fields_every | real | 1 | time | 0 | >= 0 | &
      &Time between fields written; 0: only the last.', &
    'output | checkpoint_every | real | 1 | time | 0 | >= 0 | &
      &Time between checkpoints; 0: only when a queue stops the run.', &
    'output | fields | choice | 1 or more | - | = all but the stresses | displacement rotation velocity gap &
      &contact_pressure delamination energy_release ply_damage stress face_stress | Fields written, parted by commas.']

contains

  !> Takes the table apart.
  pure subroutine load_deck_table(vocabulary)
    !> Groups and keys
    type(vocabulary_t), intent(out) :: vocabulary

    call load_vocabulary(group_rows, key_rows, vocabulary)
  end subroutine load_deck_table
end module deck_table
