!> Many fields of one shape against one: products and combinations, by BLAS, which reads several of them at once.
module field_products
  use blas_interfaces, only: dgemm, dgemv
  use kinds, only: wp
  implicit none
  private
  public :: products_with, products_of, add_combination

contains

  !> Product of a field with each of several.
  subroutine products_with(field, rows, length, fields, products)
    !> The field, (rows or more)
    real(wp), intent(in) :: field(*)
    !> How many of its values count: the first ones
    integer, intent(in) :: rows
    !> Values of one of the others
    integer, intent(in) :: length
    !> The others, (length, as many as products)
    real(wp), intent(in) :: fields(length, *)
    !> Sum over the values of field times other, (others)
    real(wp), intent(out) :: products(:)

    products = 0
    if (rows > 0 .and. size(products) > 0) &
      call dgemv('T', rows, size(products), 1.0_wp, fields, length, field, 1, 0.0_wp, products, 1)
  end subroutine products_with

  !> Products of several fields with several others.
  subroutine products_of(number, length, fields, others, products)
    !> How many fields there are of each
    integer, intent(in) :: number
    !> Values of a field
    integer, intent(in) :: length
    !> The fields, (length, number)
    real(wp), intent(in) :: fields(length, *), others(length, *)
    !> Sum over the values of field times other, field by field for each other, (number squared)
    real(wp), intent(out) :: products(*)

    products(:number**2) = 0
    if (length > 0 .and. number > 0) &
      call dgemm('T', 'N', number, number, length, 1.0_wp, fields, length, others, length, 0.0_wp, products, number)
  end subroutine products_of

  !> Adds a combination of fields to one.
  subroutine add_combination(shares, length, fields, field)
    !> Share of each, (others)
    real(wp), intent(in) :: shares(:)
    !> Values of one field
    integer, intent(in) :: length
    !> The fields to combine, (length, as many as shares)
    real(wp), intent(in) :: fields(length, *)
    !> Sum, (length)
    real(wp), intent(inout) :: field(*)

    if (length > 0 .and. size(shares) > 0) &
      call dgemv('N', length, size(shares), 1.0_wp, fields, length, shares, 1, 1.0_wp, field, 1)
  end subroutine add_combination
end module field_products
