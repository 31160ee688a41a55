!> Extents of an adaptive layered rectangle: full extents along x and y, centred on the struck point, so that a quarter
!> and the full plate have the same layers, or on that of the run whose damage the plate inherits.
module layer_extents
  use kinds, only: wp
  implicit none
  private
  public :: largest_extents

  !> Onset index from which a cell is layered, so that layers are inserted before the stress has doubled to the
  !> strength. With .25 the force of an impact changes by .09 to .16 % (doc/studies/interfaces.md).
  real(wp), parameter, public :: onset_of_layers = 0.5_wp
  !> Layered cells required ahead of damage, and additional cells of each extension, so that extensions are few. The
  !> effect of other numbers is given in doc/studies/interfaces.md.
  integer, parameter, public :: cells_ahead = 3, cells_at_once = 4
  !> Thicknesses of the laminate that the layers reach at least beyond damage, patch and starter: self-equilibrated
  !> shear decays within one (Saint-Venant's principle). More cells ahead change the force of an impact by .09 to .16 %
  !> (doc/studies/interfaces.md).
  real(wp), parameter, public :: thicknesses_ahead = 2

contains

  !> Largest extents of layers: the core, or without one the plate; a run reports if damage leaves the core.
  pure function largest_extents(extents, core, cell, length) result(largest)
    !> Present extents, those of the core, and the plate's lengths
    real(wp), intent(in) :: extents(2), core(2), length(2)
    !> Side of the core's cells; 0: no core
    real(wp), intent(in) :: cell
    !> Along x and y
    real(wp) :: largest(2)

    largest = merge(max(extents, core), length, cell > 0)
  end function largest_extents
end module layer_extents
