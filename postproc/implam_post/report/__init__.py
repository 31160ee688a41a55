"""One HTML page for a run or for a sweep with random inputs: figures, tables, pictures and provenance.
Command: `implam-report`."""
