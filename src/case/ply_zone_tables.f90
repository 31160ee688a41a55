!> Lines of `implam check` and of the log on doublers and ply drops.
module ply_zone_tables
  use deck_contents, only: deck_t
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use plies, only: plies_text
  use scale_tables, only: length_text, table_line
  use text, only: append, line_t, to_text
  implicit none
  private
  public :: ply_zone_lines

contains

  !> The lines for a checked deck: the plies of each zone, and the thickness with them; none without zones.
  function ply_zone_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    type(line_t), allocatable :: lines(:)
    integer :: i, k, next

    allocate (lines(0))
    associate (zones => deck%setup%zones)
      next = size(deck%setup%laminate%angle) + 1
      if (allocated(zones%doublers)) then
        do i = 1, size(zones%doublers)
          associate (plies => size(zones%doublers(i)%laminate%angle))
            call append(lines, table_line('doubler '''//zones%doublers(i)%name//''', '// &
                                          plies_text([(k, k=next, next + plies - 1)])//': thickness with it', &
                                          thickness_at(deck, zones%doublers(i)%at), ''))
            next = next + plies
          end associate
        end do
      end if
      if (allocated(zones%drops)) then
        do i = 1, size(zones%drops)
          call append(lines, table_line('&ply_drop '//to_text(i)//', without '//plies_text(zones%drops(i)%plies)// &
                                        ': thickness', thickness_at(deck, zones%drops(i)%at), ''))
        end do
      end if
    end associate
  end function ply_zone_lines

  !> Thickness of all plies at a point.
  function thickness_at(deck, point) result(words)
    type(deck_t), intent(in) :: deck
    !> From the plate's centre
    real(wp), intent(in) :: point(2)
    !> With its unit
    character(len=:), allocatable :: words
    type(laminate_t) :: local

    local = deck%setup%zones%laminate_of(deck%setup%laminate, deck%setup%zones%at(point))
    words = length_text(deck, sum(local%thickness))
  end function thickness_at
end module ply_zone_tables
