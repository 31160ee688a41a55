"""Run the command of this package (`python -m implam_post.sweep`)."""

from implam_post.sweep.command import main

if __name__ == "__main__":
    raise SystemExit(main())
