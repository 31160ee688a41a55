!> Size of the model that a deck describes.
module deck_sizes
  use deck_contents, only: deck_t
  use model_sizes, only: model_size_t, size_of_model
  use stepping_parameters, only: is_explicit
  implicit none
  private
  public :: size_of_deck

contains

  !> Unknowns, memory and ranks.
  pure type(model_size_t) function size_of_deck(deck)
    type(deck_t), intent(in) :: deck

    size_of_deck = size_of_model(deck%setup, is_explicit(deck%stepping))
  end function size_of_deck
end module deck_sizes
