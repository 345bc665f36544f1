"""What steady and transient results have in common: they are saved, summarised and shown.

Users expect these methods on the object itself, and reading a file makes such an object, so that
`tehl.io` needs both classes. This module is therefore the only one with imports inside functions
that close a circle; nothing else below `tehl.io` may import it.
"""

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tehl.report.headline import as_line

if TYPE_CHECKING:
    import xarray as xr


class Saved:
    """Base of `Result` and `TransientResult`, the only types of ``self``."""

    __slots__ = ()

    def save(self: Any, path: str | Path) -> None:
        """Write the result to a NetCDF-4 file; an error leaves no partial file."""
        from tehl.io.store import save  # noqa: PLC0415

        save(self, path)

    def to_xarray(self: Any) -> "xr.Dataset":
        """Return a dataset with units and long names, see `tehl.io.store.to_dataset`."""
        from tehl.io.store import to_dataset  # noqa: PLC0415

        return to_dataset(self)

    def summary(self: Any) -> dict[str, Any]:
        """Return the JSON summary that ``tehl solve --json`` prints."""
        from tehl.io.summary import summary  # noqa: PLC0415

        return summary(self)

    def __repr__(self: Any) -> str:
        """Return the main numbers in one line."""
        return as_line(type(self).__name__, self.summary())

    def _repr_html_(self: Any) -> str:
        """Return the main numbers beside a picture, for notebooks."""
        # By name, when called: the picture stands on many floors above the result.
        html: str = import_module("tehl.report.notebook").result_html(self)
        return html
