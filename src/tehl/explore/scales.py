"""Scales of the pictures: limits of colours and axes, fitted to a result or held."""

from typing import Any

from tehl.explore.colour_map import film_limits, pressure_limits, section_limits, stress_limits
from tehl.explore.curves import line_tops
from tehl.explore.shown import Shown


class Scales:
    """Limits of the colours of each view, and ends of the axes of its lines, by name."""

    def __init__(self) -> None:
        self.limits: dict[str, Any] = {}
        self.held = False

    def fit(self, shown: Shown, *, is_moving: bool) -> None:
        """Fit the scales to a result, unless they are held or a slider moves."""
        wanted: dict[str, Any] = {
            "film": film_limits(shown.maps),
            "pressure": pressure_limits(shown.maps),
            "lines": line_tops(shown.lines),
        }
        if shown.section is not None:
            wanted["temperature"] = section_limits(shown.section)
        if shown.stress is not None:
            wanted["stress"] = stress_limits(shown.stress)
        if self.held or is_moving:
            film, pressure = (
                max(ends)
                for ends in zip(wanted["lines"], self.limits.get("lines", (0.0, 0.0)), strict=True)
            )
            before, central = self.limits.get("film"), shown.maps.central
            # a film above the range would have no colour
            # the colours reach beyond the central film
            if before is not None and before.high < 1.1 * central:
                self.limits["film"] = before.joined(wanted["film"])
            wanted |= {key: value for key, value in self.limits.items() if key in wanted}
            wanted["lines"] = film, pressure  # lines stay in their frame
        self.limits = wanted
