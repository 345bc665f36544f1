"""Whether oil is balanced: criteria of the iteration beside the change of the film.

Each physics that may make or lose oil has its own: menisci must rest and sections pass the same
oil, films between surfaces that touch lose none, and those between asperities neither.
"""

import numpy as np

from tehl.contact.options import Options
from tehl.result.solution import CycleReport
from tehl.solver.cycle.level import Level
from tehl.solver.judging.outputs import asperity_balance, contact_balance, oil_balance

LARGEST_OIL_ERROR, COARSE_OIL_ERROR = 0.005, 0.003
"""Relative change of the oil flux through the contact that is accepted on the finest grid, and on
coarser ones, where it costs less."""
LONG_FRONT_CYCLES, LARGEST_OSCILLATION = 12, 0.7
"""Cycles after which single nodes of a meniscus may oscillate: then the oil flux may change by this
part of the error to reach, which its bar contains."""
BALANCED_UP_TO_X = 0.5
"""X up to which sections must pass the same oil: the film upstream decides how much, and at the
pressure spike a flux of a few percent more or less is local."""
LARGEST_MASS_ERROR, ROUNDING_RESIDUAL = 1e-10, 1e-13
"""Mass-balance error between surfaces that may touch, over what passes, which takes a few more
Newton steps, and in tight solves with asperities, over what enters, which takes ten more cycles;
and residual from which Newton steps end if they gain no more."""
CYCLE_MASS_ERROR = 0.01
"""The same where surfaces touch and cycles end at the error of the grid."""

LARGEST_MISSING_OIL = 0.05
"""Largest mass-balance error of a film that shares its load, over the oil that enters: it errs
about as much. Between asperities cycles go on until then: where the inlet conducts well, the oil
may take one more than the film (M = 920, a_y/a_x = 4.3 and spin, on 161 nodes: 240 % after two)."""


class Balance:
    """Errors of the oil balance on the present grid.

    Parameters
    ----------
    options : Options
        Accuracy, and error to reach.
    exactly : bool
        Whether a film between surfaces that touch is solved to the last digits in any case.
    is_coupled : bool
        Whether heat or shear thinning change the flow with each sweep: then to the tolerance.
    """

    def __init__(self, options: Options, *, exactly: bool, is_coupled: bool) -> None:
        self.options, self.is_tight = options, options.accuracy == "tight"
        self.largest = LARGEST_MASS_ERROR if exactly or self.is_tight else CYCLE_MASS_ERROR
        if is_coupled:
            self.largest = max(self.largest, options.tolerance)
        self.is_settled = True  # the meniscus is stationary, and sections pass the same oil
        self.is_kept = True  # a film between asperities neither makes nor loses oil
        self.oil_error = 0.0  # relative change of the flux between sections
        self.mass_error = np.inf  # between surfaces that may touch

    def note(
        self, level: Level, report: CycleReport, *, finest: bool, rests: bool, may_oscillate: bool
    ) -> None:
        """Evaluate the balances of a level after a cycle.

        Parameters
        ----------
        level : Level
            Its film is up to date.
        report : CycleReport
            Of the cycle.
        finest : bool
            Whether it is the level of the result.
        rests : bool
            Whether places where films begin are stationary.
        may_oscillate : bool
            Whether the error to reach may contain that of the flux.
        """
        if level.stencil.conserves:
            self.oil_error = oil_balance(level, until=BALANCED_UP_TO_X)
            largest = LARGEST_OIL_ERROR if finest else COARSE_OIL_ERROR
            part = LARGEST_OSCILLATION * self.options.target
            oscillates = may_oscillate and report.cycle >= LONG_FRONT_CYCLES
            self.is_settled = rests and self.oil_error <= largest
            self.is_settled |= oscillates and self.oil_error <= part
        elif level.share.by_flux and finest:
            before, self.mass_error = self.mass_error, contact_balance(level)
            rounded = report.residual <= ROUNDING_RESIDUAL and self.mass_error > 0.5 * before
            self.is_settled = self.mass_error <= self.largest or rounded
        if level.share.is_steep and finest:
            most = LARGEST_MASS_ERROR if self.is_tight else LARGEST_MISSING_OIL
            self.is_kept = asperity_balance(level) <= most
