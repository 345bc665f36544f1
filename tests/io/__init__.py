# ruff: noqa: A005 (the folder mirrors src/tehl/io)
