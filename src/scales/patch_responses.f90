!> Deflection of the struck patch under a variable force, with the modes of the plate integrated by the average
!> acceleration.
!>
!> The response to a force depends only on the number of steps since it acted. The responses of all modes are therefore
!> added to one response, with which the forces are convolved. Forces are known only up to the present step and are
!> therefore convolved in blocks of doubling size (E. Hairer, Ch. Lubich, M. Schlichte, Fast numerical solution of
!> nonlinear Volterra convolution equations, SIAM J. Sci. Stat. Comput. 6 (1985)): the number of operations grows with
!> the steps times the square of their logarithm, and not with the steps times the modes.
module patch_responses
  use fourier_transforms, only: fourier, roots_of_unity, sums_of_sines
  use kinds, only: wp
  use modal_plates, only: modal_plate_t
  implicit none
  private
  public :: patch_response_t, start_response, predicted_deflection, predict_deflections, block_steps

  !> Number of steps whose forces are convolved one by one, and largest block whose forces are convolved without
  !> transforms.
  integer, parameter :: block_steps = 64, direct_steps = 256
  !> Number of steps for which the response is computed first where the end is not known.
  integer, parameter :: first_steps = 1024

  !> A transform of one length.
  type :: spectrum_t
    !> The values
    complex(wp), allocatable :: value(:)
  end type spectrum_t

  !> The response of the patch, and stored convolutions.
  type :: patch_response_t
    !> The plate's modes
    type(modal_plate_t) :: plate
    !> Step
    real(wp) :: step = 0
    !> Deflection per force at the end of the same step
    real(wp) :: immediate = 0
    !> Deflection at a number of steps after a unit force at the end of a step
    real(wp), allocatable :: later(:)
    !> Deflection at the ends of all steps by the forces of completed blocks
    real(wp), allocatable :: predicted(:)
    !> Transforms of the response, by the exponent of the length of the block with which they are convolved, a power of
    !> two
    type(spectrum_t) :: spectra(31)
    !> Roots of unity for these transforms
    complex(wp), allocatable :: roots(:)
  end type patch_response_t

contains

  !> A plate at rest.
  pure function start_response(plate, step, steps, to_the_end) result(self)
    type(modal_plate_t), intent(in) :: plate
    real(wp), intent(in) :: step
    !> Largest number of steps
    integer, intent(in) :: steps
    !> True: all of them will be taken
    logical, intent(in) :: to_the_end
    type(patch_response_t) :: self
    integer :: known

    self%plate = plate
    self%step = step
    self%immediate = plate%rest + sum(plate%weight*step**2/4/(1 + (plate%frequency*step/2)**2))
    allocate (self%predicted(steps), source=0.0_wp)
    known = first_steps
    do while (to_the_end .and. known < steps)
      known = 2*known
    end do
    call find_unit_response(self, known)
  end function start_response

  !> Computes the response for a number of steps. By the average acceleration the phase of a mode increases by theta in
  !> a step, tan(theta/2) = omega step/2, and its response to a unit force is a sine.
  pure subroutine find_unit_response(self, steps)
    type(patch_response_t), intent(inout) :: self
    !> Steps, a power of two
    integer, intent(in) :: steps
    logical :: oscillates(size(self%plate%frequency))
    real(wp), allocatable :: omega(:)
    integer :: i

    oscillates = self%plate%frequency > 0
    omega = pack(self%plate%frequency, oscillates)
    self%later = sums_of_sines(2*atan(omega*self%step/2), &
                               pack(self%plate%weight, oscillates)*self%step/omega/(1 + (omega*self%step/2)**2), steps)
    self%later = self%later + self%step**2*sum(self%plate%weight, mask=.not. oscillates)*[(real(i, wp), i=1, steps)]
    self%roots = roots_of_unity(steps)
  end subroutine find_unit_response

  !> Deflection at the end of a step without that by the force of this step.
  pure real(wp) function predicted_deflection(self, step, force) result(deflection)
    !> The response, with the predictions up to the last multiple of `block_steps`
    type(patch_response_t), intent(in) :: self
    !> The step
    integer, intent(in) :: step
    !> Forces at the ends of all steps before
    real(wp), intent(in) :: force(:)
    integer :: since

    since = mod(step - 1, block_steps)
    deflection = self%predicted(step) + dot_product(self%later(:since), force(step - 1:step - since:-1))
  end function predicted_deflection

  !> Adds the convolution with the forces of the last block to the same number of following steps.
  pure subroutine predict_deflections(self, now, force)
    type(patch_response_t), intent(inout) :: self
    !> Steps taken, a multiple of `block_steps`
    integer, intent(in) :: now
    !> Forces at their ends
    real(wp), intent(in) :: force(:)
    integer :: length, last, k

    ! The largest power of two that divides the steps.
    length = iand(now, -now)
    last = min(now + length, size(self%predicted))
    if (.not. any(force(now - length + 1:now) > 0) .or. last <= now) return
    if (2*length > size(self%later)) call find_unit_response(self, 2*length)
    if (length > direct_steps) then
      call convolve_by_transform(self, force(now - length + 1:now), now, last)
    else
      do k = 1, length
        self%predicted(now + 1:last) = self%predicted(now + 1:last) + force(now + 1 - k)*self%later(k:k + last - now &
          - 1)
      end do
    end if
  end subroutine predict_deflections

  !> The same by transforms twice as long as the block.
  pure subroutine convolve_by_transform(self, force, now, last)
    type(patch_response_t), intent(inout) :: self
    !> Forces of the block, a power of two of them
    real(wp), intent(in) :: force(:)
    !> Steps taken, and the last step that the convolution is added to
    integer, intent(in) :: now, last
    complex(wp) :: values(2*size(force))
    integer :: length

    length = size(force)
    associate (spectrum => self%spectra(trailz(length)))
      if (.not. allocated(spectrum%value)) then
        spectrum%value = [(0.0_wp, 0.0_wp), cmplx(self%later(:2*length - 1), 0.0_wp, wp)]
        call fourier(spectrum%value, self%roots)
      end if
      values(:length) = cmplx(force, 0.0_wp, wp)
      values(length + 1:) = 0
      call fourier(values, self%roots)
      ! The inverse transform is the conjugate of the transform of the conjugate, apart from a factor.
      values = conjg(values*spectrum%value)
      call fourier(values, self%roots)
      self%predicted(now + 1:last) = self%predicted(now + 1:last) + real(values(length + 1:length + last &
                                                                                - now))/(2*length)
    end associate
  end subroutine convolve_by_transform
end module patch_responses
