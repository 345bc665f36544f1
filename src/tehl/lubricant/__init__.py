"""Oils: laws of viscosity, density and shear, each one a frozen model with one method."""

from tehl.lubricant.density import ConstantDensity, DensityLaw, DowsonHigginson
from tehl.lubricant.fluid import Lubricant, NamedLubricant, oil
from tehl.lubricant.law import DensityModel, ExponentialFall, ViscosityModel
from tehl.lubricant.roelands import Roelands, RoelandsExponential
from tehl.lubricant.shear import Carreau, Eyring, Limiting, Newtonian, ShearLaw, ShearModel
from tehl.lubricant.tait import TaitDensity, TaitDoolittle
from tehl.lubricant.viscosity import Barus, ConstantViscosity, ViscosityLaw
from tehl.lubricant.walther import Walther

__all__ = [
    "Barus",
    "Carreau",
    "ConstantDensity",
    "ConstantViscosity",
    "DensityLaw",
    "DensityModel",
    "DowsonHigginson",
    "ExponentialFall",
    "Eyring",
    "Limiting",
    "Lubricant",
    "NamedLubricant",
    "Newtonian",
    "Roelands",
    "RoelandsExponential",
    "ShearLaw",
    "ShearModel",
    "TaitDensity",
    "TaitDoolittle",
    "ViscosityLaw",
    "ViscosityModel",
    "Walther",
    "oil",
]
