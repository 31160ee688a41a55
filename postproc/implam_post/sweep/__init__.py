"""Many runs of one deck with different keys: the plan of the cases, runs that survive a stopped sweep or job, the table
of their figures, random inputs and statistics over them. Command: `implam-sweep`."""
