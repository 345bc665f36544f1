"""Number of nodes, planned for the error to reach."""

import pytest

from tehl.contact.options import Options
from tehl.estimate.domain import domain_of, far_field_error
from tehl.estimate.nodes import EXPECTED_BAR_MARGIN, FAVOURED, LIMITED_RATIO, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.estimate.settled import settled
from tehl.estimate.third_order import third_order_bar
from tests.reference import moes_contact


@pytest.mark.parametrize(("radius_ratio", "margin"), [(12.0, 1.0), (2.0, EXPECTED_BAR_MARGIN)])
def test_a_slender_flooded_contact_is_planned_without_a_margin(
    radius_ratio: float, margin: float
) -> None:
    problem = moes_contact(1000.0, 8.0, radius_ratio=radius_ratio)
    scaled, options = ScaledProblem.of(problem), settled(problem, Options(error=0.01))
    assert (scaled.groups.ellipticity > LIMITED_RATIO) is (margin == 1.0)
    domain, nodes = domain_of(scaled, options), planned(scaled, options).shape[1]
    fewer = FAVOURED[FAVOURED.index(nodes) - 1]
    bars = [third_order_bar(scaled, domain, one) for one in (nodes, fewer)]
    assert bars[0] <= (0.01 - far_field_error(scaled.groups, domain)) / margin < bars[1]
