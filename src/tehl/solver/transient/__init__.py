"""Transient films: roughness that moves with its surface, varying loads."""
