"""``python -m tehl`` is the command ``tehl``."""

from tehl.cli import main

if __name__ == "__main__":
    main()
