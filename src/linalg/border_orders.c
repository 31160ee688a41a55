/* Order of a symmetric matrix whose last rows are a border that is eliminated last: minimum degree with constraints
   (CAMD), which counts what the border adds to the rows inside. */
#include <stdlib.h>
#include "border_orders.h"

cholmod_factor *implam_border_analyze(cholmod_sparse *matrix, int border, cholmod_common *common)
{
  const int rows = (int)matrix->nrow, inside = rows - border;
  int *order = malloc((size_t)(rows + 1)*sizeof(int)), *set = malloc((size_t)(rows + 1)*sizeof(int));
  cholmod_factor *factor = 0;
  if (order && set) {
    for (int k = 0; k < rows; k++) set[k] = k >= inside;
    if (cholmod_camd(matrix, 0, 0, set, order, common)) {
      /* The border is dense in the end, so its own order is free. */
      for (int k = inside; k < rows; k++) order[k] = k;
      /* An order by the tree could take a part of the border before another's inside. */
      common->nmethods = 1;
      common->method[0].ordering = CHOLMOD_GIVEN;
      common->postorder = 0;
      factor = cholmod_analyze_p(matrix, order, 0, 0, common);
    }
  }
  free(order);
  free(set);
  return factor;
}
