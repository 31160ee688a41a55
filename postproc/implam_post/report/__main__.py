"""Run the command of this package (`python -m implam_post.report`)."""

from implam_post.report.command import main

if __name__ == "__main__":
    raise SystemExit(main())
