"""Tests of the package (`python -m unittest` in this folder's parent)."""
