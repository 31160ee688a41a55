/* Solves with a supernodal factor for one right-hand side, and for several together. */
#ifndef IMPLAM_SUPERNODAL_SOLVES_H
#define IMPLAM_SUPERNODAL_SOLVES_H
#include <stdint.h>
#include <suitesparse/cholmod.h>

/* Right-hand sides together at most: as many as a number has bits. */
enum { implam_most_together = 64 };

/* Numbers of work space that a factor asks for: the rows of its longest supernode. */
size_t implam_supernodal_work(const cholmod_factor *factor);

/* The supernode of a column. */
int implam_supernode_of(const cholmod_factor *factor, int column);

/* The two halves of a solve in place, with L and with L', by the columns before `end`: numbers in the order of the factor,
   which is supernodal, L L' and whole. Forward leaves on the others what eliminating these columns leaves of them, and
   backward begins with their solution. */
void implam_supernodal_forward(const cholmod_factor *factor, int end, double *x, double *work);
void implam_supernodal_backward(const cholmod_factor *factor, int end, double *x, double *work);

/* The same for several right-hand sides, those of each row side by side. Work space is as many times that of one; `reached`
   has a number for each supernode. */
void implam_block_forward(const cholmod_factor *factor, int end, int count, double *x, double *work, uint64_t *reached);
void implam_block_backward(const cholmod_factor *factor, int end, int count, double *x, double *work);

/* Solves in place with the dense lower factor of a matrix, by columns. */
void implam_dense_solve(int rows, const double *lower, double *x);

#endif
