"""Checkpoints are read whole, or rejected with a message."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tehl.base.errors import FileFormatError, InputError
from tehl.io.checkpoint import Fingerprint, read_checkpoint, write_checkpoint

OWNER = Fingerprint("0.1.0", "abc")


def test_a_checkpoint_comes_back_as_it_was_written(tmp_path):
    state = {"pressure": np.arange(6.0).reshape(2, 3), "setting": np.array(1)}
    write_checkpoint(tmp_path / "run.checkpoint", OWNER, state)
    found = read_checkpoint(tmp_path / "run.checkpoint", OWNER)
    assert set(found) == set(state)
    assert (found["pressure"] == state["pressure"]).all()


@pytest.mark.parametrize(
    ("found", "place", "harm"),
    [
        (b"PK\x01\x02", 6, b"\x6d"),  # a zip of version 10.9
        (b"PK\x01\x02", 8, b"\x01"),  # encrypted
        (b"{'descr'", 0, b"(((((((("),  # the header of an array ends nowhere
    ],
)
def test_a_damaged_header_is_reported(tmp_path, found, place, harm):
    path = tmp_path / "run.checkpoint"
    write_checkpoint(path, OWNER, {"pressure": np.ones(3)})
    content = path.read_bytes()
    start = content.rindex(found) + place
    path.write_bytes(content[:start] + harm + content[start + len(harm) :])
    with pytest.raises(FileFormatError, match="is not a complete checkpoint"):
        read_checkpoint(path, OWNER)


@pytest.mark.parametrize(
    ("owner", "words"),
    [
        (OWNER._replace(version="0.2.0"), "written by tehl 0.1.0, and this is 0.2.0"),
        (OWNER._replace(input="def"), "belongs to another case"),
    ],
)
def test_a_checkpoint_of_another_run_is_rejected(tmp_path, owner, words):
    write_checkpoint(tmp_path / "run.checkpoint", OWNER, {"pressure": np.ones(3)})
    with pytest.raises(InputError, match=words):
        read_checkpoint(tmp_path / "run.checkpoint", owner)


@given(data=st.data())
def test_a_flipped_bit_anywhere_is_reported_or_harmless(data, tmp_path_factory):
    path = tmp_path_factory.mktemp("damaged") / "run.checkpoint"
    write_checkpoint(path, OWNER, {"pressure": np.ones(3)})
    content = bytearray(path.read_bytes())
    place = data.draw(st.integers(0, len(content) - 1))
    content[place] ^= 1 << data.draw(st.integers(0, 7))
    path.write_bytes(content)
    with suppress(FileFormatError, InputError):
        read_checkpoint(path, OWNER)
