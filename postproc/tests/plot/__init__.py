"""Tests of implam_post.plot."""
