"""What is refused of a file in HDF5, whichever library reads it then."""

from pathlib import Path
from typing import Any

from tehl.errors import InputError

MAGIC = b"\x89HDF"
"""The first bytes of a file."""


def check_hdf5(path: Path) -> None:
    """Refuse data in other files; raise what h5py does where h5netcdf would complain aloud.

    Raises
    ------
    InputError
        If a part of the file lies in another one, which a map has no business to read.
    """
    import h5py  # noqa: PLC0415

    with h5py.File(path, "r") as file:
        list(file.attrs.items())
        # neither follows an external link; both stop at the first that is found
        if file.visititems_links(_leads_out) or file.visititems(_lies_outside):
            raise InputError(
                "has data in another file (external storage, an external link or a virtual "
                "dataset), and a map is read from its own file only: copy all into one file"
            )


def _leads_out(_: str, link: Any) -> bool | None:
    """Return True for a link into another file, and None to go on."""
    import h5py  # noqa: PLC0415

    return isinstance(link, h5py.ExternalLink) or None


def _lies_outside(_: str, thing: Any) -> bool | None:
    """Return True for a dataset whose numbers may lie in another file, and None to go on."""
    import h5py  # noqa: PLC0415

    is_table = isinstance(thing, h5py.Dataset)
    return (is_table and (thing.is_virtual or thing.external is not None)) or None
