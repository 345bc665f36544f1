"""Pressure far from the contact: similarity solution, edges of a grid, load outside."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from tehl.contact.options import Domain
from tehl.estimate.grid import Grid
from tehl.estimate.scaling import groups
from tehl.operators.far_field import FarField, Gap, angular_pressure, angular_squeeze
from tehl.operators.film import gap
from tests.reference import moes_contact

GROUPS = groups(moes_contact(2.0, 5.0))
DOMAIN = Domain(x=(-20.0, 10.0), y=(-15.0, 15.0))


def test_the_pressure_of_a_circular_contact_is_the_closed_form():
    angle, f = angular_pressure(Gap(1.0))
    front = math.atan(3.0)
    # f and f' vanish at the front
    factor = 0.1 * math.cos(front) / math.cosh(3.0 * (math.pi - front))
    expected = factor * np.cosh(3.0 * (math.pi - angle)) - 0.1 * np.cos(angle)
    assert f == pytest.approx(np.where(angle > front, expected, 0.0), abs=1e-4 * f.max())


@pytest.mark.parametrize(
    "gap", [Gap(0.2), Gap(0.5), Gap(2.0), Gap(5.0), Gap(0.5, 0.4), Gap(1.0, -0.9), Gap(6.0, 2.0)]
)
def test_the_pressure_solves_its_equation_where_it_is_positive(gap):
    angle, f = angular_pressure(gap)
    cosine, sine = np.cos(angle), np.sin(angle)
    g = (cosine**2 + 2.0 * gap.twist * cosine * sine + gap.ratio * sine**2) ** 3
    flux = 0.5 * (g[1:] + g[:-1]) * np.diff(f) / np.diff(angle)
    left = np.diff(flux) / np.diff(angle)[0] - 9.0 * g[1:-1] * f[1:-1]
    wet, opening = f[1:-1] > 0.0, (cosine + gap.twist * sine)[1:-1]
    assert left[wet] == pytest.approx(opening[wet], abs=2e-6 * max(g.max(), 1.0))
    assert np.all(opening[~wet] >= -1e-12)  # dry where the gap opens
    assert np.all(np.diff(f[f > 0.0])[:3] > 0.0)


def test_the_rays_of_a_turned_gap_go_round_it_as_those_of_its_mirror_image_do():
    angle, f = angular_pressure(Gap(0.5, 0.4))
    mirrored, other = angular_pressure(Gap(0.5, -0.4))
    assert other[::-1] == pytest.approx(f, abs=1e-9)
    assert mirrored[::-1] == pytest.approx(2.0 * np.pi - angle)
    assert f[0] == f[-1] == 0.0
    radii = Gap(0.5, 0.4).radii(angle, (-3.0, 2.0), (-1.0, 4.0))[0]
    x, y = radii * np.cos(angle), radii * np.sin(angle)
    assert np.minimum(np.minimum(x + 3.0, 2.0 - x), np.minimum(y + 1.0, 4.0 - y)) == pytest.approx(
        0.0, abs=1e-9
    )


@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_far_from_the_cavity_the_squeeze_is_that_of_paraboloids(ratio):
    # without cavitation -lambda / (2 (1 + D) H^2) solves (H^3 P')' = lambda dH/dt: q = 2 / (1 + D)
    # upstream on the axis, where H = r^2 / 2
    squeeze = angular_squeeze(Gap(ratio))
    assert squeeze[-1] == pytest.approx(2.0 / (1.0 + ratio), rel=0.02)
    assert squeeze.min() > -1e-9
    assert np.abs(squeeze[angular_pressure(Gap(ratio))[1] == 0.0]).max() < 1e-9


def test_the_slopes_are_those_of_edges_and_load():
    grid = Grid(nx=65, ny=65, domain=DOMAIN, mirror=False)
    far, flat, step = FarField(grid, GROUPS), gap(grid, GROUPS), 1e-4
    found = far.slopes(flat + 3.0, flat)
    fields = []
    for film in (flat + 3.0 + step, flat + 3.0 - step):
        pressure = np.zeros(grid.shape)
        far.set_edges(pressure, film)
        fields.append((pressure, far.load(film, flat)))
    (more, load), (less, other) = fields
    assert found.by_film == pytest.approx((more - less) / (2.0 * step), rel=1e-6, abs=1e-15)
    assert found.load_by_film.sum() == pytest.approx((load - other) / (2.0 * step), rel=1e-6)
    # outside of the inlet the squeeze resists
    assert (found.by_rate <= 0.0).all()
    assert found.load_by_rate < 0.0


def test_the_edges_have_the_pressure_of_the_rigid_gap():
    grid = Grid(nx=65, ny=65, domain=DOMAIN, mirror=False)
    far, pressure = FarField(grid, GROUPS), np.zeros(grid.shape)
    far.set_edges(pressure, gap(grid, GROUPS))
    _, f = angular_pressure(Gap(1.0))
    # upstream on the axis
    assert pressure[32, 0] == pytest.approx(8.0 * GROUPS.lambda_bar * f[-1] / 20.0**3, rel=1e-6)
    assert pressure[32, -1] == 0.0
    assert pressure[0] == pytest.approx(pressure[-1])
    assert np.count_nonzero(pressure[1:-1, 1:-1]) == 0


def test_the_load_outside_is_the_integral_of_the_pressure():
    grid = Grid(nx=65, ny=65, domain=DOMAIN, mirror=False)
    far, base, (angle, f) = FarField(grid, GROUPS), 3.0, angular_pressure(Gap(1.0))
    field = gap(grid, GROUPS)

    def ray(a: float) -> float:
        """Integral of P r dr from the edge outwards."""
        cosine, sine = math.cos(a), math.sin(a)
        ends = [(10.0 if cosine > 0 else -20.0) / cosine, 15.0 / sine]
        start = min(ends)
        shape = float(np.interp(a, angle, f))

        def integrand(r: float) -> float:
            return 2.0 * GROUPS.lambda_bar * shape * r**2 / (base + 0.5 * r**2) ** 2

        return quad(integrand, start, math.inf)[0]

    expected = 2.0 * quad(ray, 1e-6, math.pi - 1e-6, limit=200)[0]
    assert far.load(field + base, field) == pytest.approx(expected, rel=1e-3)
