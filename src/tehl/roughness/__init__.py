"""Heights of the surfaces, positive outwards."""

from tehl.roughness.smooth import Smooth

__all__ = ["Smooth"]
