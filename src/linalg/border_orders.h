/* Orders for a symmetric matrix whose last rows are a border that is eliminated last. */
#ifndef IMPLAM_BORDER_ORDERS_H
#define IMPLAM_BORDER_ORDERS_H
#include <suitesparse/cholmod.h>

/* Orders a matrix given by its lower triangle and finds the pattern of its factor; null without memory. */
cholmod_factor *implam_border_analyze(cholmod_sparse *matrix, int border, cholmod_common *common);

#endif
