"""Run the command of this package (`python -m implam_post.study`)."""

from implam_post.study.command import main

if __name__ == "__main__":
    raise SystemExit(main())
