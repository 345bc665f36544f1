"""Oils: laws of viscosity, density and shear, each one a frozen model with one method."""

from tehl.lubricant.density import ConstantDensity, DensityLaw, DowsonHigginson
from tehl.lubricant.fluid import Lubricant, NamedLubricant, library, oil
from tehl.lubricant.shear import Carreau, Eyring, Limiting, Newtonian, ShearLaw
from tehl.lubricant.viscosity import Barus, ConstantViscosity, Roelands, ViscosityLaw

__all__ = [
    "Barus",
    "Carreau",
    "ConstantDensity",
    "ConstantViscosity",
    "DensityLaw",
    "DowsonHigginson",
    "Eyring",
    "Limiting",
    "Lubricant",
    "NamedLubricant",
    "Newtonian",
    "Roelands",
    "ShearLaw",
    "ViscosityLaw",
    "library",
    "oil",
]
