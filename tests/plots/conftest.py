"""Pictures as a user sees them."""

import pytest


@pytest.fixture(autouse=True)
def unarranged():
    """Search the places of all parts."""
