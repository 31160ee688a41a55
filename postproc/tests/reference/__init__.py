"""Tests of implam_post.reference."""
