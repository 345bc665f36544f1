"""Heights of the surfaces, positive outwards."""

from tehl.roughness.features import Bump, Dimple, Ridge
from tehl.roughness.map import Crop, Map
from tehl.roughness.protocol import Roughness
from tehl.roughness.random_surface import Random
from tehl.roughness.smooth import Smooth
from tehl.roughness.superposition import Superposition
from tehl.roughness.surface import AnyRoughness, Sum
from tehl.roughness.waves import Crossed, Wave, WaveVector

__all__ = [
    "AnyRoughness",
    "Bump",
    "Crop",
    "Crossed",
    "Dimple",
    "Map",
    "Random",
    "Ridge",
    "Roughness",
    "Smooth",
    "Sum",
    "Superposition",
    "Wave",
    "WaveVector",
]
