"""Exchange of panels with other programs: import and export of Nastran bulk data, export of Abaqus input."""

import numpy as np

# pyNastran 1.4 imports np.in1d, which numpy 2.4 no longer has.
if not hasattr(np, "in1d"):
    np.in1d = np.isin
