"""A measured surface for tests."""

from tehl.roughness import Map
from tehl.roughness.prepare import levelled
from tests.roughness.files import relief

NY, NX = 48, 64
PIXEL = 2e-6
HEIGHTS = relief(NY, NX)


def stated(file, **keys):
    return Map.model_validate({"file": file, "unit": "um", "pixel": "2 um", **keys})


def levelled_map():
    return levelled(HEIGHTS, "plane")
