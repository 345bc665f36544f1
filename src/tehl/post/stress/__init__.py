"""Stress below the surface of both bodies, from pressure and traction of a result."""
