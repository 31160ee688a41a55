"""Tests of implam_post.study."""
