"""Tests of implam_post.exchange."""
