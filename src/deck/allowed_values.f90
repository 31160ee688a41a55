!> The allowed values of a key in words, for messages and explanations.
module allowed_values
  use deck_vocabulary, only: key_entry_t
  use text, only: line_t, joined, words_of
  implicit none
  private
  public :: allowed_sentence, branch_of

contains

  !> Allowed values of a key, for the end of a message.
  pure recursive function allowed_sentence(key) result(sentence)
    type(key_entry_t), intent(in) :: key
    !> Such as `allowed: 2 real values > 0`
    character(len=:), allocatable :: sentence
    type(line_t), allocatable :: choices(:)

    if (key%kind == 'choice or real') then
      sentence = allowed_sentence(branch_of(key, 'real'))
      sentence = allowed_sentence(branch_of(key, 'choice'))//' or'//sentence(len('allowed:') + 1:)
      return
    end if
    select case (key%kind)
    case ('logical')
      sentence = '.true. or .false.'
    case ('choice')
      choices = words_of(key%allowed, ' ')
      sentence = key%values//' of '''//joined(choices, ''', ''')//''''
    case ('name')
      sentence = counted_kind(key%values, key%kind)//' of up to 80 characters: '//key%allowed// &
                 ', the first a letter or digit'
    case ('text')
      sentence = counted_kind(key%values, 'text')//' in quotes'
      if (key%allowed /= 'any text') sentence = sentence//', '//key%allowed
    case ('real')
      sentence = counted_kind(key%values, 'real value')
      if (key%allowed /= 'any') sentence = sentence//' '//key%allowed
    case default
      sentence = counted_kind(key%values, key%kind)
      if (key%allowed /= 'any') sentence = sentence//' '//key%allowed
    end select
    sentence = 'allowed: '//sentence
  end function allowed_sentence

  !> A number of values with their noun, such as `1 real value or one for each ply`.
  pure function counted_kind(number, noun) result(words)
    !> Number of values as the table has it, and what a value is
    character(len=*), intent(in) :: number, noun
    character(len=:), allocatable :: words

    select case (number)
    case ('1')
      words = '1 '//noun
    case ('plies')
      words = 'one '//noun//' for each ply'
    case ('1 or plies')
      words = '1 '//noun//' or one for each ply'
    case default
      words = number//' '//noun//'s'
    end select
  end function counted_kind

  !> The part of a key that accepts a choice or a number for one of the two; in the table its choices precede the
  !> conditions.
  pure function branch_of(key, kind) result(branch)
    type(key_entry_t), intent(in) :: key
    !> `choice` or `real`
    character(len=*), intent(in) :: kind
    !> A key of that kind alone
    type(key_entry_t) :: branch
    integer :: comma

    branch = key
    branch%kind = kind
    comma = index(key%allowed, ',')
    branch%allowed = key%allowed(:comma - 1)
    if (kind == 'real') branch%allowed = key%allowed(comma + 2:)
  end function branch_of
end module allowed_values
