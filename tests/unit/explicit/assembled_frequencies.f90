!> Highest frequency of an assembled plate by power iteration, to compare bounds with.
module assembled_frequencies
  use element_batches, only: lanes
  use exact_sums, only: exact_sum_t
  use internal_forces, only: add_internal_force
  use kinds, only: long, wp
  use layer_motions, only: accelerate
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  use plate_options, only: kinematics_linear
  use rank_totals, only: total_of
  implicit none
  private
  public :: highest_frequency

  !> Products of the iteration.
  integer, parameter :: products = 60

contains

  !> Highest angular frequency of the assembled plate. Collective.
  real(wp) function highest_frequency(model, stiffness, inertia) result(omega)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Lumped inertia, inverted without springs
    type(nodal_inertia_t), intent(in) :: inertia
    real(wp), allocatable :: x(:, :), force(:, :)
    real(wp) :: size_of_x, energy
    integer :: i, k, product

    allocate (x(5, size(model%distribution%points)), force(5, model%borders%columns))
    do i = 1, size(x, 2)
      do k = 1, 5
        x(k, i) = scattered(5*model%distribution%points(i) + k)
        ! Motion of like energy: rotations turn the layer's thickness.
        if (inertia%inverse(7, i) > 0 .and. k > 3) x(k, i) = x(k, i)*sqrt(inertia%inverse(3, i)/inertia%inverse(7, i))
      end do
      where (inertia%held(:, i)) x(:, i) = 0
    end do
    call inertia%spread(x)
    omega = 0
    do product = 1, products
      call model%halo%update(x)
      force = 0
      call add_internal_force(model%elements, stiffness, kinematics_linear, x, force, energy)
      call model%borders%add(force)
      call inertia%fold(force)
      x = 0
      do i = 1, model%distribution%owned
        call accelerate(inertia%inverse(:, i), 1.0_wp, force(:, i), x(:, i))
      end do
      call inertia%spread(x)
      size_of_x = maxval(abs(x(:, :model%distribution%owned)))
      call model%communicator%maximum(size_of_x)
      if (.not. size_of_x > 0) return
      x = x/size_of_x
    end do
    omega = sqrt(rayleigh(model, stiffness, inertia, x))
  end function highest_frequency

  !> Rayleigh's quotient of a field. Collective.
  real(wp) function rayleigh(model, stiffness, inertia, x) result(quotient)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Lumped inertia
    type(nodal_inertia_t), intent(in) :: inertia
    !> The field, (5, points)
    real(wp), contiguous, intent(inout) :: x(:, :)
    real(wp) :: force(5, model%borders%columns), energies(lanes, model%elements%batches), energy
    type(exact_sum_t) :: kinetic
    integer :: i

    call model%halo%update(x)
    force = 0
    call add_internal_force(model%elements, stiffness, kinematics_linear, x, force, energy, energies=energies)
    do i = 1, model%distribution%owned
      associate (m => inertia%mass(:, i), a => x(:, i))
        call kinetic%add((m(1)*(a(1)**2 + a(2)**2) + m(3)*(a(4)**2 + a(5)**2) + m(4)*a(3)**2)/2 &
                         + m(2)*(a(1)*a(4) + a(2)*a(5)))
      end associate
    end do
    quotient = total_of(model%communicator, energies)/total_of(model%communicator, kinetic)
  end function rayleigh

  !> A number between -1 and 1 that goes with another one, the same everywhere (G. Marsaglia, Journal of Statistical Software
  !> 8 (2003) 14, xorshift).
  pure real(wp) function scattered(number)
    !> The other number
    integer, intent(in) :: number
    integer(long) :: bits

    bits = number*2654435761_long
    bits = ieor(bits, ishft(bits, 13))
    bits = ieor(bits, ishft(bits, -7))
    bits = ieor(bits, ishft(bits, 17))
    scattered = real(iand(bits, 2_long**31 - 1), wp)/2.0_wp**30 - 1
  end function scattered
end module assembled_frequencies
