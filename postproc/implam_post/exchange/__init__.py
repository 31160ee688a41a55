"""Exchange of panels with other programs: Nastran's bulk data both ways, Abaqus' input one way."""

import numpy as np

# pyNastran 1.4 imports this by its old name, which numpy 2.4 no longer has.
if not hasattr(np, "in1d"):
    np.in1d = np.isin
