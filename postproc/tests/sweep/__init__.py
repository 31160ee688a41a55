"""Tests of implam_post.sweep."""
