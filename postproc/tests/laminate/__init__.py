"""Tests of implam_post.laminate."""
