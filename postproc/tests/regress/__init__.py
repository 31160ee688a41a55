"""Tests of implam_post.regress."""
