/* Elimination of the rows inside a border. */
#ifndef IMPLAM_SUBSTRUCTURES_H
#define IMPLAM_SUBSTRUCTURES_H
#include <suitesparse/cholmod.h>

/* Outcomes of a factorization. */
enum { implam_factored = 0, implam_not_positive = 1, implam_failed = 2 };

/* Finds the columns of a supernodal factor L L' before `inside`, of the lower triangle of a matrix in the factor's order, and
   the lower triangle of what is left of the other rows, by columns; numbers above its diagonal are left as they are. */
int implam_eliminate(cholmod_factor *factor, const cholmod_sparse *matrix, int inside, int *lists, double *work,
                     double *complement);

/* How long the lists and the work space of `implam_eliminate` are; they may be the same each time. */
size_t implam_elimination_lists(const cholmod_factor *factor);
size_t implam_elimination_work(const cholmod_factor *factor, int inside);

#endif
