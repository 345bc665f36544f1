"""Shear laws: how the stress follows the shear rate."""

from typing import Literal

from pydantic import BaseModel, ConfigDict


class Newtonian(BaseModel):
    """Stress is viscosity times shear rate, however large."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    law: Literal["newtonian"] = "newtonian"


ShearLaw = Newtonian
"""A union as soon as there is a second law."""
