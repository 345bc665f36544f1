"""Tables of pages in Markdown."""


def row(*cells: object) -> str:
    """Return one line of a table."""
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def head(*names: str) -> list[str]:
    """Return the two first lines of a table."""
    return [row(*names), row(*("---:" for _ in names))]
