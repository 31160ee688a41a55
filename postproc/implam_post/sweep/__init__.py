"""Many runs of a deck with different keys: plan of the cases, runs that can be continued after a stop of the sweep or
job, table of their figures, random inputs and their statistics. Command: `implam-sweep`."""
