"""Run the command of this package (`python -m implam_post.plot`)."""

from implam_post.plot.command import main

if __name__ == "__main__":
    raise SystemExit(main())
