"""A case file for the tests of this folder."""

from pathlib import Path

import pytest

CASE = """
title = "a ball"
[contact]
radius = "20 mm"
load = "80 N"
entrainment_speed = "1.5 m/s"
[surface_1]
material = "steel"
[surface_2]
material = { young_modulus = "82 GPa", poisson_ratio = 0.206 }
[lubricant]
viscosity = { law = "roelands", eta_0 = "0.04 Pa s", alpha = "22 1/GPa" }
density = { law = "dowson-higginson", rho_0 = "890 kg/m^3" }
[numerics]
points = 129
domain = { x = [-4.5, 1.5], y = [-3.0, 3.0] }
"""


@pytest.fixture
def case(tmp_path: Path) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8")
    return path
