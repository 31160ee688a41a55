/* CHOLMOD behind procedures that Fortran can call: a symmetric positive definite matrix, whose lists stay the caller's,
   and its supernodal factor (Chen et al., ACM Trans. Math. Softw. 35, 2008). The last rows may be a border, which is
   left over: its Schur complement is found instead of its factor. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>
#include "border_orders.h"
#include "substructures.h"
#include "supernodal_solves.h"

typedef struct {
  cholmod_common common;
  cholmod_sparse matrix;
  cholmod_factor *factor;
  /* Rows of the border. */
  int border;
  /* The matrix in the order of the factor, and where each of its values goes there. */
  cholmod_sparse *ordered;
  int *places;
  /* Lists and work space of an elimination, kept as new memory takes time. */
  int *lists;
  double *work;
  /* One right-hand side in the order of the factor, and work space behind it. */
  double *one;
  /* The same for several, those of each row side by side, and where they have been; what was needed so far. */
  double *several;
  uint64_t *reached;
  size_t room;
} implam_cholmod;

/* A matrix by its lower triangle in compressed columns, from 0, which is its upper one in compressed rows, and how many
   of its last rows are a border; null without memory. */
implam_cholmod *implam_cholmod_new(int rows, int border, int *start, int *columns, double *values)
{
  implam_cholmod *self = calloc(1, sizeof *self);
  if (!self) return 0;
  self->border = border;
  cholmod_start(&self->common);
  self->common.supernodal = CHOLMOD_SUPERNODAL;
  self->common.quick_return_if_not_posdef = 1;
  self->common.print = 0;
  /* Orders leave rows of more than ten roots of their number out of sight, unless told not to: those of a border between
     ranks, or of many layers. The factor then gets more numbers, 1.8 times as many in test_substructures.pf. */
  for (int k = 0; k < CHOLMOD_MAXMETHODS; k++) self->common.method[k].prune_dense = -1;
  cholmod_sparse *a = &self->matrix;
  a->nrow = a->ncol = (size_t)rows;
  a->nzmax = (size_t)start[rows];
  a->p = start;
  a->i = columns;
  a->x = values;
  a->stype = -1;
  a->itype = CHOLMOD_INT;
  a->xtype = CHOLMOD_REAL;
  a->dtype = CHOLMOD_DOUBLE;
  a->sorted = a->packed = 1;
  return self;
}

/* Orders the matrix, the border last, and finds the pattern of its factor; null without memory. */
static cholmod_factor *analyze(implam_cholmod *self)
{
  return self->border ? implam_border_analyze(&self->matrix, self->border, &self->common)
                      : cholmod_analyze(&self->matrix, &self->common);
}

/* Finds once where the values go: cholmod_factorize would transpose the matrix twice each time, which takes up to 40 % of
   what the numbers take. Lower triangle by columns; a column's rows need no order. 0 without memory. */
static int order_matrix(implam_cholmod *self)
{
  const int n = (int)self->matrix.nrow, *start = self->matrix.p, *rows = self->matrix.i;
  const int *order = self->factor->Perm;
  int *place_of = malloc((size_t)(n + 1)*sizeof(int));
  self->places = malloc((self->matrix.nzmax + 1)*sizeof(int));
  self->ordered = cholmod_allocate_sparse((size_t)n, (size_t)n, self->matrix.nzmax, 0, 1, -1, CHOLMOD_REAL,
                                          &self->common);
  if (place_of && self->places && self->ordered) {
    int *first = self->ordered->p, *its_rows = self->ordered->i;
    for (int k = 0; k < n; k++) place_of[order[k]] = k;
    for (int j = 0; j <= n; j++) first[j] = 0;
    for (int j = 0; j < n; j++)
      for (int k = start[j]; k < start[j + 1]; k++) {
        const int a = place_of[rows[k]], b = place_of[j];
        first[(a < b ? a : b) + 1]++;
      }
    for (int j = 0; j < n; j++) first[j + 1] += first[j];
    for (int j = 0; j < n; j++)
      for (int k = start[j]; k < start[j + 1]; k++) {
        const int a = place_of[rows[k]], b = place_of[j];
        const int place = first[a < b ? a : b]++;
        its_rows[place] = a < b ? b : a;
        self->places[k] = place;
      }
    for (int j = n; j > 0; j--) first[j] = first[j - 1];
    first[0] = 0;
  } else {
    free(self->places);
    self->places = 0;
    cholmod_free_sparse(&self->ordered, &self->common);
  }
  free(place_of);
  return self->places != 0;
}

/* Puts the values as they are now in the order of the factor, which is found the first time; 0 without memory. */
static int order_values(implam_cholmod *self)
{
  self->common.status = CHOLMOD_OK;
  if (!self->factor) self->factor = analyze(self);
  if (!self->factor) return 0;
  if (!self->places && !order_matrix(self)) return 0;
  if (!self->one) self->one = malloc((self->matrix.nrow + implam_supernodal_work(self->factor))*sizeof(double));
  if (!self->one) return 0;
  const double *values = self->matrix.x;
  double *ordered = self->ordered->x;
  for (size_t k = 0; k < self->matrix.nzmax; k++) ordered[self->places[k]] = values[k];
  return 1;
}

/* Factors a matrix without border as its values are now. */
int implam_cholmod_factorize(implam_cholmod *self)
{
  double none[2] = {0, 0};
  if (!order_values(self)) return implam_failed;
  if (!cholmod_super_numeric(self->ordered, 0, none, self->factor, &self->common)) return implam_failed;
  if (self->common.status == CHOLMOD_NOT_POSDEF || self->factor->minor < self->factor->n) return implam_not_positive;
  return self->common.status == CHOLMOD_OK ? implam_factored : implam_failed;
}

/* Eliminates what is inside the border from the matrix as its values are now. Leaves the lower triangle of the border's
   Schur complement, by columns; numbers above its diagonal are left as they are. */
int implam_cholmod_eliminate(implam_cholmod *self, double *complement)
{
  if (!order_values(self)) return implam_failed;
  const int inside = (int)self->matrix.nrow - self->border;
  /* The first time: room for the numbers. */
  if (self->factor->xtype == CHOLMOD_PATTERN &&
      !cholmod_change_factor(CHOLMOD_REAL, 1, 1, 1, 1, self->factor, &self->common)) return implam_failed;
  if (!self->lists) self->lists = malloc((implam_elimination_lists(self->factor) + 1)*sizeof(int));
  if (!self->work) self->work = malloc((implam_elimination_work(self->factor, inside) + 1)*sizeof(double));
  if (!self->lists || !self->work) return implam_failed;
  return implam_eliminate(self->factor, self->ordered, inside, self->lists, self->work, complement);
}

/* Room for several right-hand sides and what solving for a block of them needs; 0 without memory. */
static int make_room(implam_cholmod *self, int count)
{
  const size_t needed = (size_t)count*self->matrix.nrow + implam_most_together*implam_supernodal_work(self->factor);
  if (!self->reached) self->reached = malloc((self->factor->nsuper + 1)*sizeof(uint64_t));
  if (needed > self->room) {
    free(self->several);
    self->several = malloc(needed*sizeof(double));
    self->room = self->several ? needed : 0;
  }
  return self->reached && self->several;
}

/* Puts columns that stand one behind the other side by side, row `order[k]` of them in place k. */
static void side_by_side(size_t rows, size_t count, const int *order, const double *columns, double *several)
{
  for (size_t k = 0; k < rows; k++)
    for (size_t c = 0; c < count; c++) several[k*count + c] = columns[c*rows + (size_t)order[k]];
}

/* The opposite. */
static void one_behind_the_other(size_t rows, size_t count, const int *order, const double *several, double *columns)
{
  for (size_t k = 0; k < rows; k++)
    for (size_t c = 0; c < count; c++) columns[c*rows + (size_t)order[k]] = several[k*count + c];
}

/* Right-hand sides of a block that begins with one of them. */
static int block_at(int first, int count)
{
  return count - first < implam_most_together ? count - first : implam_most_together;
}

/* Eliminates what is inside the border from right-hand sides, one behind the other, and keeps that for
   `implam_cholmod_backward`. Gives what is left of them on the border; 0 for success. */
int implam_cholmod_forward(implam_cholmod *self, int count, const double *right_hand_sides, double *left)
{
  const size_t rows = self->matrix.nrow, border = (size_t)self->border, inside = rows - border;
  const int *order = self->factor->Perm;
  if (count == 1) {
    for (size_t k = 0; k < rows; k++) self->one[k] = right_hand_sides[order[k]];
    implam_supernodal_forward(self->factor, (int)inside, self->one, self->one + rows);
    memcpy(left, self->one + inside, border*sizeof(double));
    return implam_factored;
  }
  if (!make_room(self, count)) return implam_failed;
  double *work = self->several + (size_t)count*rows;
  for (int first = 0; first < count; first += implam_most_together) {
    const int together = block_at(first, count);
    double *its = self->several + (size_t)first*rows, *left_of_it = left + (size_t)first*border;
    side_by_side(rows, (size_t)together, order, right_hand_sides + (size_t)first*rows, its);
    implam_block_forward(self->factor, (int)inside, together, its, work, self->reached);
    for (size_t k = 0; k < border; k++)
      for (size_t c = 0; c < (size_t)together; c++)
        left_of_it[c*border + k] = its[(inside + k)*(size_t)together + c];
  }
  return implam_factored;
}

/* Solutions from what `implam_cholmod_forward` kept and the border's solutions, as many. */
void implam_cholmod_backward(implam_cholmod *self, int count, const double *on_border, double *solutions)
{
  const size_t rows = self->matrix.nrow, border = (size_t)self->border, inside = rows - border;
  const int *order = self->factor->Perm;
  if (count == 1) {
    memcpy(self->one + inside, on_border, border*sizeof(double));
    implam_supernodal_backward(self->factor, (int)inside, self->one, self->one + rows);
    for (size_t k = 0; k < rows; k++) solutions[order[k]] = self->one[k];
    return;
  }
  double *work = self->several + (size_t)count*rows;
  for (int first = 0; first < count; first += implam_most_together) {
    const int together = block_at(first, count);
    const double *its_border = on_border + (size_t)first*border;
    double *its = self->several + (size_t)first*rows;
    for (size_t k = 0; k < border; k++)
      for (size_t c = 0; c < (size_t)together; c++)
        its[(inside + k)*(size_t)together + c] = its_border[c*border + k];
    implam_block_backward(self->factor, (int)inside, together, its, work);
    one_behind_the_other(rows, (size_t)together, order, its, solutions + (size_t)first*rows);
  }
}

/* Solves for right-hand sides of a matrix without border, one behind the other; 0 for success. */
int implam_cholmod_solve(implam_cholmod *self, int count, const double *right_hand_sides, double *solutions)
{
  double none;
  const int outcome = implam_cholmod_forward(self, count, right_hand_sides, &none);
  if (outcome == implam_factored) implam_cholmod_backward(self, count, &none, solutions);
  return outcome;
}

/* Entries stored in the factor, and the most memory that was in use, in bytes. */
void implam_cholmod_size(const implam_cholmod *self, double *entries, double *bytes)
{
  *entries = self->factor ? (double)self->factor->xsize : 0;
  *bytes = (double)self->common.memory_usage;
}

/* Frees all but the matrix. */
void implam_cholmod_free(implam_cholmod *self)
{
  if (!self) return;
  cholmod_free_factor(&self->factor, &self->common);
  cholmod_free_sparse(&self->ordered, &self->common);
  free(self->places);
  free(self->lists);
  free(self->work);
  free(self->one);
  free(self->several);
  free(self->reached);
  cholmod_finish(&self->common);
  free(self);
}
