"""Temperatures of bodies that pass on as much heat as the contact gives them.

Each body with a thermal resistance R_s has ``T_s = T_oil + R_s Q_s(T_1, T_2)``
(docs/theory/thermal.md on temperatures of the bodies). Heat flows from the warmer body through the
film into the other one, so both equations are solved together, by Newton's method: slopes by
differences at first, then updated from each step (Broyden 1965).
"""

from collections.abc import Callable

from tehl.base.errors import TehlError
from tehl.base.typing import Array, np
from tehl.contact.problem import HOTTEST_TEMPERATURE, ContactProblem

MOST_STEPS = 20
"""Steps after which the balance has failed."""

Heats = Callable[[float, float], tuple[float, float] | None]
"""Heat into both bodies at their temperatures [W]; None where no film is found."""


RUNAWAY = "thermal_runaway"
"""Cause where the heat warms a body more than any oil bears."""


class NotBalancedError(TehlError):
    """The heat of the contact has no balance; ``cause`` names why."""

    def __init__(self, cause: str, message: str) -> None:
        super().__init__(message)
        self.cause = cause


def balanced(problem: ContactProblem, heats: Heats) -> tuple[float, float]:
    """Return the temperatures of both bodies at which heat in equals heat out [K].

    The last call of ``heats`` is at these temperatures; the first one at that of the oil.

    Parameters
    ----------
    problem : ContactProblem
        With the thermal resistance of a body, or of both.
    heats : callable
        Heat into both bodies [W] at their temperatures [K]; None if a film fails.

    Raises
    ------
    NotBalancedError
        ``"thermal_runaway"`` if a body exceeds `HOTTEST_TEMPERATURE`, ``"bodies_not_balanced"`` if
        the steps do not settle or a film fails.
    """
    assert problem.heat is not None
    excess = _Excess(problem, heats)
    temperatures = np.array([problem.heat.bulk_1, problem.heat.bulk_2])
    _, left = excess.after(temperatures, np.zeros(2))
    slopes: Array = np.diag([-1.0, -1.0])
    for body in np.nonzero(excess.free & (not excess.is_settled))[0].tolist():
        step, other = excess.after(temperatures, 2.0 * np.eye(2)[body])  # kelvin
        slopes[:, body] = (other - left) / step[body]
        excess.is_settled = False
    for _ in range(MOST_STEPS):
        if excess.is_settled:
            return float(temperatures[0]), float(temperatures[1])
        newton = np.asarray(np.linalg.solve(slopes, -left), np.float64)
        if not float(newton @ left) > 0.0:  # the heat rises faster than it is passed on
            newton = np.where(left > 0.0, HOTTEST_TEMPERATURE, left)
        excess.aim = temperatures + newton
        newton *= min(1.0, 30.0 / float(np.abs(newton).max()))  # at most 30 K in a step
        step, now = excess.after(temperatures, newton)
        slopes += np.outer(now - left - slopes @ step, step) / float(step @ step)
        temperatures += step
        left = now
    raise NotBalancedError(
        "bodies_not_balanced",
        f"After {MOST_STEPS} steps the temperatures of the bodies are "
        f"{float(np.abs(left).max()):.2g} K from the balance of their heat.",
    )


class _Excess:
    """What the heat of the contact warms the bodies beyond their temperatures [K]."""

    def __init__(self, problem: ContactProblem, heats: Heats) -> None:
        self.inlet, self.heats, self.is_settled = problem.inlet_temperature, heats, False
        known = problem.resistances
        self.aim = np.zeros(2)
        """Temperatures of the next step without its limit [K]."""
        self.free = np.array([one is not None for one in known])
        self.resistance = np.array([one or 0.0 for one in known])

    def after(self, temperatures: Array, step: Array) -> tuple[Array, Array]:
        """Return the step from ``temperatures``, halved until a film is found, and the excess."""
        for _ in range(4):
            if (left := self._at(temperatures + step)) is not None:
                return step, left
            step = 0.5 * step
        self._check(self.aim, ", and no film was found on the way there")
        raise NotBalancedError(
            "bodies_not_balanced", "On the way to the balance of the bodies a film failed."
        )

    def _check(self, temperatures: Array, failure: str = "") -> None:
        """Raise if a body is too hot."""
        if not float(temperatures.max()) <= HOTTEST_TEMPERATURE:
            hottest = int(temperatures.argmax())
            raise NotBalancedError(
                RUNAWAY,
                f"Thermal runaway: the heat of the contact warms body {hottest + 1}, of "
                f"{self.resistance[hottest]:.3g} K/W, beyond {HOTTEST_TEMPERATURE:g} K{failure}.",
            )

    def _at(self, temperatures: Array) -> Array | None:
        self._check(temperatures)
        heat = self.heats(*temperatures.tolist())
        if heat is None:
            return None
        rise = self.resistance * heat
        left = np.where(self.free, self.inlet + rise - temperatures, 0.0)
        limit = np.maximum(1e-6 * np.abs(rise), 1e-7)  # of the heat [-], or of a temperature [K]
        self.is_settled = bool((np.abs(left) <= limit).all())
        return left
