/* CHOLMOD behind five procedures that Fortran can call: a symmetric positive definite matrix, whose lists stay the
   caller's, and its supernodal factor (Chen et al., ACM Trans. Math. Softw. 35, 2008). */
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>

typedef struct {
  cholmod_common common;
  cholmod_sparse matrix;
  cholmod_factor *factor;
  /* What solves leave for the next: solution and work space. */
  cholmod_dense *solution, *work, *spare;
} implam_cholmod;

/* Outcomes of a factorization. */
enum { factored = 0, not_positive = 1, failed = 2 };

/* A matrix by its lower triangle in compressed columns, from 0, which is its upper one in compressed rows; null without
   memory. */
implam_cholmod *implam_cholmod_new(int rows, int *start, int *columns, double *values)
{
  implam_cholmod *self = calloc(1, sizeof *self);
  if (!self) return 0;
  cholmod_start(&self->common);
  self->common.supernodal = CHOLMOD_SUPERNODAL;
  self->common.quick_return_if_not_posdef = 1;
  self->common.print = 0;
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

/* Factors the matrix as its values are now; orders it the first time. */
int implam_cholmod_factorize(implam_cholmod *self)
{
  self->common.status = CHOLMOD_OK;
  if (!self->factor) self->factor = cholmod_analyze(&self->matrix, &self->common);
  if (!self->factor) return failed;
  if (!cholmod_factorize(&self->matrix, self->factor, &self->common)) return failed;
  if (self->common.status == CHOLMOD_NOT_POSDEF || self->factor->minor < self->factor->n) return not_positive;
  return self->common.status == CHOLMOD_OK ? factored : failed;
}

/* Solves for right-hand sides that stand one behind the other; 0 for success. */
int implam_cholmod_solve(implam_cholmod *self, int count, double *right_hand_sides, double *solutions)
{
  const size_t rows = self->matrix.nrow;
  cholmod_dense right = {.nrow = rows, .ncol = (size_t)count, .nzmax = rows*(size_t)count, .d = rows,
                         .x = right_hand_sides, .xtype = CHOLMOD_REAL, .dtype = CHOLMOD_DOUBLE};
  if (!cholmod_solve2(CHOLMOD_A, self->factor, &right, 0, &self->solution, 0, &self->work, &self->spare, &self->common))
    return failed;
  memcpy(solutions, self->solution->x, rows*(size_t)count*sizeof(double));
  return 0;
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
  cholmod_free_dense(&self->solution, &self->common);
  cholmod_free_dense(&self->work, &self->common);
  cholmod_free_dense(&self->spare, &self->common);
  cholmod_finish(&self->common);
  free(self);
}
