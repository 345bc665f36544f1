"""Oils: laws of viscosity, density and shear, each one a frozen model with one method."""

from tehl.lubricant.density import ConstantDensity, DensityLaw, DowsonHigginson
from tehl.lubricant.fluid import Lubricant, NamedLubricant, oil
from tehl.lubricant.roelands import Roelands, RoelandsExponential
from tehl.lubricant.shear import Carreau, Eyring, Limiting, Newtonian, ShearLaw
from tehl.lubricant.tait import TaitDensity, TaitDoolittle
from tehl.lubricant.viscosity import Barus, ConstantViscosity, ViscosityLaw
from tehl.lubricant.walther import Walther

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
    "RoelandsExponential",
    "ShearLaw",
    "TaitDensity",
    "TaitDoolittle",
    "ViscosityLaw",
    "Walther",
    "oil",
]
