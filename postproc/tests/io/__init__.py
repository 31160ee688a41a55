"""Tests of implam_post.io."""
