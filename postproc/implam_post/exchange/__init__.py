"""Exchange of panels with other programs: Nastran's bulk data both ways, Abaqus' input one way."""
