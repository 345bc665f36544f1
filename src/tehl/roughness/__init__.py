"""Heights of the surfaces, positive outwards."""

from tehl.roughness.features import Bump, Dimple, Pocket, Ridge
from tehl.roughness.formula import Formula
from tehl.roughness.map import Map
from tehl.roughness.map_settings import Crop
from tehl.roughness.model import Roughness, Smooth
from tehl.roughness.random import Random
from tehl.roughness.superposition import AnyRoughness, Sum, Superposition
from tehl.roughness.waves import Crossed, Wave, WaveVector

__all__ = [
    "AnyRoughness",
    "Bump",
    "Crop",
    "Crossed",
    "Dimple",
    "Formula",
    "Map",
    "Pocket",
    "Random",
    "Ridge",
    "Roughness",
    "Smooth",
    "Sum",
    "Superposition",
    "Wave",
    "WaveVector",
]
