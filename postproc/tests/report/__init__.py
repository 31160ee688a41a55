"""Tests of implam_post.report."""
