"""Run the command of this package (`python -m implam_post.regress`)."""

from implam_post.regress.command import main

if __name__ == "__main__":
    raise SystemExit(main())
