"""Classical laminate theory with first-order transverse shear: materials and plies of a deck, stacking sequences in the
usual notation, stiffness and mass of a section. It shares no code with the solver."""
