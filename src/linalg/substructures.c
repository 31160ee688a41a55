/* Elimination of the rows inside a border (substructuring, Przemieniecki, AIAA J. 1, 1963): the columns of a supernodal
   factor before those of the border, and the border's Schur complement. CHOLMOD factors the border too, which takes
   b^3/3 operations, and as many to multiply that out again. Left-looking: a supernode is brought up to date by those
   before it that reach it, which hang in its list (Ng and Peyton, SIAM J. Sci. Comput. 14, 1993). */
#include <string.h>
#include "blas.h"
#include "substructures.h"
#include "supernodal_solves.h"

static const double one = 1, minus_one = -1, zero = 0;

/* Columns of a panel, which are found or multiplied together: 24 to 64 take the same time within 3 %. */
enum { panel = 32 };
static const int panel_rows = panel;

typedef struct {
  const cholmod_factor *factor;
  /* Columns to be found. */
  int inside;
  /* Place of each row in the supernode at hand. */
  int *place;
  /* Rows of each supernode that later ones have used. */
  int *used;
  /* The first supernode that reaches each, and the next one in the same list; -1: none. */
  int *reaching, *next;
  /* Where the rows of one supernode stand in another. */
  int *goes;
  /* What one supernode adds to another. */
  double *update;
} elimination;

/* Columns of a supernode that are to be found. */
static int columns_of(const elimination *e, int k)
{
  const int *first = e->factor->super;
  return (first[k + 1] < e->inside ? first[k + 1] : e->inside) - first[k];
}

static int rows_of(const elimination *e, int k)
{
  const int *list = e->factor->pi;
  return list[k + 1] - list[k];
}

static const int *row_list(const elimination *e, int k)
{
  return (const int *)e->factor->s + ((const int *)e->factor->pi)[k];
}

static double *block_of(const elimination *e, int k)
{
  return (double *)e->factor->x + ((const int *)e->factor->px)[k];
}

/* Puts the matrix in the place of a supernode. */
static void put_matrix(const elimination *e, const cholmod_sparse *matrix, int k)
{
  const int *start = matrix->p, *its_row = matrix->i, first = ((const int *)e->factor->super)[k];
  const double *values = matrix->x;
  const int rows = rows_of(e, k), columns = columns_of(e, k), *row = row_list(e, k);
  double *block = block_of(e, k);
  for (int i = 0; i < rows; i++) e->place[row[i]] = i;
  for (size_t i = 0; i < (size_t)rows*(size_t)columns; i++) block[i] = 0;
  for (int j = 0; j < columns; j++)
    for (int n = start[first + j]; n < start[first + j + 1]; n++)
      block[(size_t)j*(size_t)rows + (size_t)e->place[its_row[n]]] = values[n];
}

/* Products of the rows of a supernode from `begin` on with those from there to `end`: the lower triangle of the latter
   and all below; numbers above it mean nothing. Where it is small BLAS takes longer to leave that out. */
static void multiply(const elimination *e, int k, int begin, int end)
{
  const int rows = rows_of(e, k), columns = columns_of(e, k), all = rows - begin;
  const double *block = block_of(e, k) + begin;
  for (int j = 0; j < end - begin; j += panel) {
    const int across = end - begin - j < panel ? end - begin - j : panel, below = all - j;
    dgemm_("N", "T", &below, &across, &columns, &one, block + j, &rows, block + j, &rows, &zero,
           e->update + (size_t)j*(size_t)all + j, &all);
  }
}

/* Takes what an earlier supernode adds to one from it. */
static void take_off(const elimination *e, int earlier, int k)
{
  const int rows = rows_of(e, k), its_rows = rows_of(e, earlier), begin = e->used[earlier];
  const int past = ((const int *)e->factor->super)[k] + columns_of(e, k), *row = row_list(e, earlier);
  int end = begin;
  while (end < its_rows && row[end] < past) end++;
  const int all = its_rows - begin;
  double *block = block_of(e, k);
  multiply(e, earlier, begin, end);
  for (int i = 0; i < all; i++) e->goes[i] = e->place[row[begin + i]];
  for (int j = 0; j < end - begin; j++) {
    double *column = block + (size_t)e->goes[j]*(size_t)rows;
    const double *its_column = e->update + (size_t)j*(size_t)all;
    for (int i = j; i < all; i++) column[e->goes[i]] -= its_column[i];
  }
  e->used[earlier] = end;
}

/* Hangs a supernode in the list of the next one that it reaches, if that is to be found. */
static void hang(elimination *e, int k)
{
  if (e->used[k] == rows_of(e, k)) return;
  const int row = row_list(e, k)[e->used[k]];
  if (row >= e->inside) return;
  const int later = implam_supernode_of(e->factor, row);
  e->next[k] = e->reaching[later];
  e->reaching[later] = k;
}

/* Inverse of the lower triangle at the beginning of a block, of a panel's columns at most. */
static void invert(int columns, int rows, const double *block, double *inverse)
{
  for (int j = 0; j < columns; j++) {
    double *column = inverse + j*panel;
    for (int i = 0; i < columns; i++) column[i] = i == j;
    for (int k = j; k < columns; k++) {
      const double *its = block + (size_t)k*(size_t)rows, x = column[k] /= its[k];
      for (int i = k + 1; i < columns; i++) column[i] -= its[i]*x;
    }
  }
}

/* Cholesky's factorization of a supernode by panels; 0 unless it is positive definite. Nearly all of it are products:
   BLAS takes twice to five times as long to solve with a small triangle as to multiply. */
static int factor_columns(const elimination *e, int rows, int columns, double *block)
{
  double inverse[panel*panel];
  for (int j = 0; j < columns; j += panel) {
    const int across = columns - j < panel ? columns - j : panel, left = rows - j, below = left - across;
    double *its = block + (size_t)j*(size_t)rows + j, *under = its + across;
    int info = 0;
    if (j > 0) dgemm_("N", "T", &left, &across, &j, &minus_one, block + j, &rows, block + j, &rows, &one, its, &rows);
    dpotrf_("L", &across, its, &rows, &info);
    if (info != 0) return 0;
    if (below == 0) continue;
    invert(across, rows, its, inverse);
    for (int c = 0; c < across; c++)
      memcpy(e->update + (size_t)c*(size_t)below, under + (size_t)c*(size_t)rows, (size_t)below*sizeof(double));
    dgemm_("N", "T", &below, &across, &across, &one, e->update, &below, inverse, &panel_rows, &zero, under, &rows);
  }
  return 1;
}

/* Finds the columns of a supernode; 0 unless it is positive definite. */
static int factor_supernode(elimination *e, const cholmod_sparse *matrix, int k)
{
  put_matrix(e, matrix, k);
  for (int earlier = e->reaching[k], following; earlier >= 0; earlier = following) {
    following = e->next[earlier];
    take_off(e, earlier, k);
    hang(e, earlier);
  }
  if (!factor_columns(e, rows_of(e, k), columns_of(e, k), block_of(e, k))) return 0;
  e->used[k] = columns_of(e, k);
  hang(e, k);
  return 1;
}

/* The border's matrix, less what the supernodes take from it. */
static void find_complement(const elimination *e, const cholmod_sparse *matrix, int supernodes, double *complement)
{
  const int *start = matrix->p, *its_row = matrix->i, n = (int)matrix->nrow;
  const double *values = matrix->x;
  const size_t border = (size_t)(n - e->inside);
  for (size_t j = 0; j < border; j++)
    for (size_t i = j; i < border; i++) complement[j*border + i] = 0;
  for (int j = e->inside; j < n; j++)
    for (int i = start[j]; i < start[j + 1]; i++)
      complement[(size_t)(j - e->inside)*border + (size_t)(its_row[i] - e->inside)] = values[i];
  for (int k = 0; k < supernodes; k++) {
    const int rows = rows_of(e, k), begin = e->used[k], all = rows - begin, *row = row_list(e, k) + begin;
    if (all == 0) continue;
    multiply(e, k, begin, rows);
    for (int j = 0; j < all; j++) {
      double *column = complement + (size_t)(row[j] - e->inside)*border;
      const double *its_column = e->update + (size_t)j*(size_t)all;
      for (int i = j; i < all; i++) column[row[i] - e->inside] -= its_column[i];
    }
  }
}

size_t implam_elimination_lists(const cholmod_factor *factor)
{
  return 2*factor->n + 3*factor->nsuper;
}

size_t implam_elimination_work(const cholmod_factor *factor, int inside)
{
  const size_t border = factor->n - (size_t)inside, panels = panel*implam_supernodal_work(factor);
  const size_t most = factor->maxcsize > border*border ? factor->maxcsize : border*border;
  return panels > most ? panels : most;
}

int implam_eliminate(cholmod_factor *factor, const cholmod_sparse *matrix, int inside, int *lists, double *work,
                     double *complement)
{
  const size_t n = factor->n, most = factor->nsuper;
  elimination e = {factor, inside, lists, lists + n, lists + n + most, lists + n + 2*most, lists + n + 3*most, work};
  int supernodes = 0;
  for (size_t k = 0; k < most; k++) e.reaching[k] = -1;
  for (; supernodes < (int)most && ((const int *)factor->super)[supernodes] < inside; supernodes++)
    if (!factor_supernode(&e, matrix, supernodes)) return implam_not_positive;
  find_complement(&e, matrix, supernodes, complement);
  return implam_factored;
}
