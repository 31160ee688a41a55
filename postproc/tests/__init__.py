"""Tests of the package (run `python -m unittest` in postproc/)."""
