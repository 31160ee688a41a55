/* Solves with a supernodal factor for one right-hand side. */
#ifndef IMPLAM_SUPERNODAL_SOLVES_H
#define IMPLAM_SUPERNODAL_SOLVES_H
#include <suitesparse/cholmod.h>

/* Numbers of work space that a factor asks for: the rows of its longest supernode. */
size_t implam_supernodal_work(const cholmod_factor *factor);

/* Solves in place, right-hand side and solution in the order of the factor, which is supernodal, L L' and whole. */
void implam_supernodal_solve(const cholmod_factor *factor, double *x, double *work);

#endif
