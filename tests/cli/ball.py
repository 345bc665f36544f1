"""A ball on a disc as a case file, and what lies in its folder."""

CASE = """
title = "Ball"
[contact]
radius = "20 mm"
load = "80 N"
entrainment_speed = "1.5 m/s"
[surface_1]
material = "steel"
[surface_2]
material = "steel"
[lubricant]
viscosity = { law = "roelands", eta_0 = "0.04 Pa s", alpha = "22 1/GPa" }
density = { law = "dowson-higginson", rho_0 = "890 kg/m^3" }
"""


def names(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())
