!> The impactor in steps by central differences: motion by the contact force at the start of the step, or by a
!> prescribed travel; contact force from the indentation at the end of the step.
module impactor_steps
  use archives, only: archive_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use smooth_starts, only: smooth_ramp
  use states, only: state_t
  use step_lengths, only: allow_for, step_lengths_t
  use struck_patches, only: struck_patch_t
  use tan_sun_indentation, only: commit_indentation, indentation_force, indentation_stiffness, indentation_t
  implicit none
  private
  public :: impactor_steps_t

  !> The impactor.
  type :: impactor_steps_t
    !> Its contact area
    type(struck_patch_t) :: patch
    !> Its velocity at the middle of the last step
    real(wp) :: velocity = 0
    !> The contact's frequency allowed for by the step
    real(wp) :: frequency = 0
    !> Work of a prescribed travel
    real(wp) :: work = 0
    !> Energy lost by changes of the step length
    real(wp) :: loss = 0
  contains
    procedure :: allowed_square
    procedure :: contact_square
    procedure :: place
    procedure :: move
    procedure :: energy
    procedure :: visit
  end type impactor_steps_t

contains

  !> Square of the contact's frequency that the step allows for.
  real(wp) function allowed_square(self, plate, indentation) result(square)
    class(impactor_steps_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(indentation_t), intent(in) :: indentation

    call allow_for(sqrt(self%contact_square(plate, indentation)), self%frequency)
    square = self%frequency**2
  end function allowed_square

  !> Square of the frequency of the contact between the impactor and the mass under the patch, theory (T6). A nose is a
  !> spring to each of its points, of which the stiffest on the lightest mass is a bound, and, where the law is steeper
  !> than Hertz's for this force, one to their mean.
  pure real(wp) function contact_square(self, plate, indentation) result(square)
    class(impactor_steps_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    type(indentation_t), intent(in) :: indentation
    real(wp) :: slope, inverse_mass

    inverse_mass = 0
    if (.not. plate%setup%impactor%travel > 0) inverse_mass = 1/plate%setup%impactor%mass
    associate (patch => self%patch, law => plate%setup%impactor%indentation, copies => plate%mesh%multiplicity)
      slope = indentation_stiffness(law, indentation, indentation%alpha)
      square = 0
      if (any(patch%slopes > 0)) then
        associate (force => indentation_force(law, indentation, indentation%alpha))
          slope = max(0.0_wp, slope - 1.5_wp*force/indentation%alpha)
          square = patch%gain*force*(maxval(patch%slopes*patch%inverse)/copies + sum(patch%slopes)*inverse_mass)
        end associate
      end if
      square = square + patch%gain**2*slope*(sum(patch%weights**2*patch%inverse)/copies + inverse_mass)
    end associate
  end function contact_square

  !> Places the impactor at first contact with the deflected face, or in the dent of an earlier run. Collective.
  subroutine place(self, model, now)
    class(impactor_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> The state; receives the deflections under the impactor
    type(state_t), intent(inout) :: now
    real(wp) :: w(size(self%patch%weights))

    call self%patch%find_deflections(model%plate, now%motion%displacement, w, now%impact%deflection)
    call self%patch%touch(w, now%impact%indentation%dent)
    now%impact%patch_mean = now%impact%impactor%displacement - now%impact%indentation%dent
    if (allocated(model%nose)) then
      now%impact%patch%touched_at = -self%patch%offset
    else
      now%impact%patch%offset = self%patch%offset
    end if
  end subroutine place

  !> Updates the motion of the impactor, and finds the force at the end of the step. Until the loads start it stays
  !> at first contact with a plate that comes to rest. Collective.
  subroutine move(self, model, steps, now)
    class(impactor_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(step_lengths_t), intent(in) :: steps
    !> The state at the end of the step; receives the motion of the impactor
    type(state_t), intent(inout) :: now
    real(wp) :: alpha, before, change, w(size(self%patch%weights))

    if (model%plate%setup%impactor%is_present .and. now%time <= model%plate%setup%loading%start) then
      call self%place(model, now)
      ! The velocity at the middle of a step, with the full one at its end.
      self%velocity = now%impact%impactor%velocity - steps%now/2*model%plate%setup%impactor%gravity
      return
    end if
    call self%patch%find_deflections(model%plate, now%motion%displacement, w, now%impact%deflection)
    if (.not. model%plate%setup%impactor%is_present) then
      call self%patch%find_indentation(w, 0.0_wp, alpha)
      now%impact%patch_mean = -alpha
      return
    end if
    associate (impactor => now%impact%impactor, parameters => model%plate%setup%impactor, &
               ramp_time => model%plate%setup%loading%ramp_time)
      before = now%impact%force
      if (parameters%travel > 0) then
        change = parameters%travel*smooth_ramp(now%time/ramp_time, parameters%rise/ramp_time, 0) - impactor%displacement
        self%velocity = change/steps%now
      else
        call accelerate(self, model%plate, steps, before)
        change = steps%now*self%velocity
      end if
      impactor%displacement = impactor%displacement + change
      call self%patch%find_indentation(w, impactor%displacement, alpha)
      now%impact%patch_mean = impactor%displacement - alpha
      now%impact%force = self%patch%gain*indentation_force(model%plate%setup%impactor%indentation, &
                                                           now%impact%indentation, alpha)
      call commit_indentation(model%plate%setup%impactor%indentation, now%impact%indentation, alpha)
      impactor%force = now%impact%force
      impactor%velocity = self%velocity
      if (parameters%travel > 0) then
        self%work = self%work + (before + now%impact%force)/2*change
      else
        impactor%velocity = impactor%velocity + steps%now/2*(parameters%gravity - now%impact%force/parameters%mass)
      end if
    end associate
  end subroutine move

  !> Velocity at the middle of the step, and the energy lost by a change of its length (`step_lengths`).
  pure subroutine accelerate(self, plate, steps, force)
    type(impactor_steps_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(step_lengths_t), intent(in) :: steps
    !> Contact force at the start of the step
    real(wp), intent(in) :: force
    real(wp) :: acceleration

    associate (parameters => plate%setup%impactor)
      acceleration = parameters%gravity - force/parameters%mass
      self%loss = self%loss + parameters%mass*acceleration**2*(steps%now - steps%last)/4*steps%mean()
      self%velocity = self%velocity + steps%mean()*acceleration
    end associate
  end subroutine accelerate

  !> Kinetic energy at the end of a step, defined as that of the plate, and potential of gravity.
  pure real(wp) function energy(self, model, step, now)
    class(impactor_steps_t), intent(in) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: step
    type(state_t), intent(in) :: now

    associate (parameters => model%plate%setup%impactor)
      energy = parameters%mass*(self%velocity*(self%velocity + step*(parameters%gravity &
        - now%impact%force/parameters%mass))/2 - parameters%gravity*now%impact%impactor%displacement)
    end associate
  end function energy

  !> Saves or loads.
  subroutine visit(self, archive)
    class(impactor_steps_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call self%patch%visit(archive)
    call archive%item('explicit/impactor_velocity', self%velocity)
    call archive%item('explicit/contact_frequency', self%frequency)
    call archive%item('explicit/travel_work', self%work)
    call archive%item('explicit/impactor_loss', self%loss)
  end subroutine visit
end module impactor_steps
