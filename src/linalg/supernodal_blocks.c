/* Solves with a supernodal factor L L' for several right-hand sides together. Each row's numbers of all right-hand sides
   stand side by side, so what a supernode needs of them is copied row by row. On the way there a supernode takes only
   those right-hand sides that have reached it: a unit force reaches those between it and the root of the elimination
   tree. CHOLMOD's own solves take the whole factor. */
#include <stdint.h>
#include <string.h>
#include "blas.h"
#include "supernodal_solves.h"

static const double one = 1, minus_one = -1, zero = 0;

int implam_supernode_of(const cholmod_factor *factor, int column)
{
  const int *first = factor->super;
  int low = 0, high = (int)factor->nsuper;
  while (high - low > 1) {
    const int middle = low + (high - low)/2;
    if (first[middle] <= column) low = middle;
    else high = middle;
  }
  return low;
}

/* Marks the supernodes in which right-hand sides have numbers other than zero, one bit each. */
static void mark(const cholmod_factor *factor, int count, const double *x, uint64_t *reached)
{
  const int *first = factor->super;
  for (int k = 0; k < (int)factor->nsuper; k++) {
    reached[k] = 0;
    for (int row = first[k]; row < first[k + 1]; row++)
      for (int c = 0; c < count; c++)
        if (x[(size_t)row*(size_t)count + (size_t)c] != 0) reached[k] |= (uint64_t)1 << c;
  }
}

/* Right-hand sides whose bits are set; how many. */
static int list_of(uint64_t bits, int count, int *list)
{
  int listed = 0;
  for (int c = 0; c < count; c++)
    if (bits >> c & 1) list[listed++] = c;
  return listed;
}

void implam_block_forward(const cholmod_factor *factor, int end, int count, double *x, double *work, uint64_t *reached)
{
  const int *first = factor->super, *list = factor->pi, *place = factor->px, *row = factor->s;
  const double *values = factor->x;
  int some[implam_most_together];
  mark(factor, count, x, reached);
  for (int k = 0; k < (int)factor->nsuper && first[k] < end; k++) {
    const int number = list_of(reached[k], count, some);
    if (number == 0) continue;
    const int rows = list[k + 1] - list[k], *its_row = row + list[k], past = first[k + 1] < end ? first[k + 1] : end;
    const int columns = past - first[k], below = rows - columns;
    double *own = work, *others = work + (size_t)columns*(size_t)number;
    for (int j = 0; j < columns; j++)
      for (int c = 0; c < number; c++) own[j*number + c] = x[(size_t)(first[k] + j)*(size_t)count + (size_t)some[c]];
    dtrsm_("R", "L", "T", "N", &number, &columns, &one, values + place[k], &rows, own, &number);
    for (int j = 0; j < columns; j++)
      for (int c = 0; c < number; c++) x[(size_t)(first[k] + j)*(size_t)count + (size_t)some[c]] = own[j*number + c];
    if (below == 0) continue;
    dgemm_("N", "T", &number, &below, &columns, &one, own, &number, values + place[k] + columns, &rows, &zero, others,
           &number);
    for (int i = 0; i < below; i++) {
      double *its = x + (size_t)its_row[columns + i]*(size_t)count;
      for (int c = 0; c < number; c++) its[some[c]] -= others[i*number + c];
    }
    /* All rows below are in supernodes between this one's parent and the root. */
    reached[implam_supernode_of(factor, its_row[columns])] |= reached[k];
  }
}

void implam_block_backward(const cholmod_factor *factor, int end, int count, double *x, double *work)
{
  const int *first = factor->super, *list = factor->pi, *place = factor->px, *row = factor->s;
  const double *values = factor->x;
  for (int k = (int)factor->nsuper - 1; k >= 0; k--) {
    const int past = first[k + 1] < end ? first[k + 1] : end, columns = past - first[k];
    if (columns <= 0) continue;
    const int rows = list[k + 1] - list[k], below = rows - columns, *its_row = row + list[k];
    double *own = x + (size_t)first[k]*(size_t)count;
    for (int i = 0; i < below; i++)
      memcpy(work + (size_t)i*(size_t)count, x + (size_t)its_row[columns + i]*(size_t)count,
             (size_t)count*sizeof(double));
    if (below)
      dgemm_("N", "N", &count, &columns, &below, &minus_one, work, &count, values + place[k] + columns, &rows, &one, own,
             &count);
    dtrsm_("R", "L", "N", "N", &count, &columns, &one, values + place[k], &rows, own, &count);
  }
}
