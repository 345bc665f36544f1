"""The units that quantities may have: their factors to SI and their dimensions."""

import math

Dimension = tuple[int, int, int, int]
"""Exponents of metre, kilogram, second, kelvin."""

NONE: Dimension = (0, 0, 0, 0)
MASS: Dimension = (0, 1, 0, 0)
FORCE: Dimension = (1, 1, -2, 0)
_PRESSURE: Dimension = (-1, 1, -2, 0)
_ENERGY: Dimension = (2, 1, -2, 0)
_POWER: Dimension = (2, 1, -3, 0)

_PREFIXES = {"n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6}
_PREFIXES["G"] = 1e9
_PREFIXED: dict[str, tuple[float, Dimension]] = {
    "m": (1.0, (1, 0, 0, 0)),
    "g": (1e-3, (0, 1, 0, 0)),
    "s": (1.0, (0, 0, 1, 0)),
    "N": (1.0, FORCE),
    "Pa": (1.0, _PRESSURE),
    "J": (1.0, _ENERGY),
    "W": (1.0, _POWER),
    "Hz": (1.0, (0, 0, -1, 0)),
    "Pas": (1.0, (-1, 1, -1, 0)),
    "Ns": (1.0, (1, 1, -1, 0)),
    "Nm": (1.0, _ENERGY),
    "l": (1e-3, (3, 0, 0, 0)),
    "L": (1e-3, (3, 0, 0, 0)),
}
_INCH, _POUND = 0.0254, 4.4482216152605
"""Metres of an inch and newtons of a pound-force, both exactly."""
_PSI = _POUND / _INCH**2
UNITS: dict[str, tuple[float, Dimension]] = {
    prefix + name: (scale * factor, dimension)
    for name, (factor, dimension) in _PREFIXED.items()
    for prefix, scale in _PREFIXES.items()
} | {
    "1": (1.0, NONE),
    "-": (1.0, NONE),
    "%": (0.01, NONE),
    "rad": (1.0, NONE),
    "mrad": (1e-3, NONE),
    "deg": (math.pi / 180.0, NONE),
    "°": (math.pi / 180.0, NONE),
    "arcmin": (math.pi / 10800.0, NONE),
    "K": (1.0, (0, 0, 0, 1)),
    "degC": (1.0, (0, 0, 0, 1)),
    "°C": (1.0, (0, 0, 0, 1)),
    "cm": (1e-2, (1, 0, 0, 0)),
    "dm": (1e-1, (1, 0, 0, 0)),
    "mK": (1.0, (1, 0, 0, 1)),  # W/mK of data sheets is W/(m K)
    "kgK": (1.0, (0, 1, 0, 1)),
    "min": (60.0, (0, 0, 1, 0)),
    "h": (3600.0, (0, 0, 1, 0)),
    "bar": (1e5, _PRESSURE),
    "cP": (1e-3, (-1, 1, -1, 0)),
    "P": (0.1, (-1, 1, -1, 0)),
    "cSt": (1e-6, (2, 0, -1, 0)),
    "St": (1e-4, (2, 0, -1, 0)),
    **dict.fromkeys(("in", "inch"), (_INCH, (1, 0, 0, 0))),
    **dict.fromkeys(("mil", "thou"), (1e-3 * _INCH, (1, 0, 0, 0))),
    **dict.fromkeys(("uin", "µin", "μin", "microinch"), (1e-6 * _INCH, (1, 0, 0, 0))),
    "ft": (12.0 * _INCH, (1, 0, 0, 0)),
    "lbf": (_POUND, FORCE),
    "lb": (_POUND / 9.80665, MASS),
    "psi": (_PSI, _PRESSURE),
    "ksi": (1e3 * _PSI, _PRESSURE),
    "Msi": (1e6 * _PSI, _PRESSURE),
    "reyn": (_PSI, (-1, 1, -1, 0)),
    **dict.fromkeys(("degF", "°F"), (5.0 / 9.0, (0, 0, 0, 1))),
}
"""Factor to SI and dimension of each unit that may stand in a product."""
TEMPERATURES = {
    **dict.fromkeys(("degC", "°C", "C", "deg C"), (1.0, 273.15)),
    **dict.fromkeys(("degF", "°F", "F", "deg F"), (5.0 / 9.0, 273.15 - 160.0 / 9.0)),
}
"""Kelvins per degree, and temperature at zero degrees [K]."""
ANGLE_UNITS = ("rad", "mrad", "deg", "°", "arcmin")
"""Units of plain numbers that are angles."""
