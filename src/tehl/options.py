"""How hard to try: the numerical choices of a run, the ``[numerics]`` table of a case file."""

import math
from typing import Annotated, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from tehl.errors import InputError


def _not_a_truth(value: object) -> object:
    """Refuse true and false, which Python takes for 1 and 0."""
    if isinstance(value, bool):
        raise ValueError("is not a number")
    return value


Real = Annotated[float, BeforeValidator(_not_a_truth)]
Count = Annotated[int, BeforeValidator(_not_a_truth)]
Nodes = Annotated[Count, Field(ge=17, le=16385)]
Interval = tuple[Real, Real]
LARGEST_COARSEST = 64
"""Most intervals along one direction of the coarsest grid, which is solved densely."""
FARTHEST = 1e3
"""Hertz half-widths within which a domain must stay."""


class Domain(BaseModel):
    """Rectangle on which the film is computed, in Hertz half-widths.

    Attributes
    ----------
    x, y : tuple of float
        Inlet and outlet edge, and the two side edges [-].
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    x: Interval
    y: Interval

    @model_validator(mode="after")
    def _must_hold_the_contact(self) -> Self:
        for name, edges in (("x", self.x), ("y", self.y)):
            if fault := _fault_of_edges(*edges):
                raise ValueError(f"{name} = [{edges[0]:g}, {edges[1]:g}] {fault}")
        return self


def _fault_of_edges(low: float, high: float) -> str:
    """Return what is wrong with two edges of a domain, nothing if they will do."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return "must be two finite numbers, in Hertz half-widths, such as [-4.5, 1.5]"
    if low >= high:
        return f"must begin with its lower edge: [{high:g}, {low:g}] (unit: Hertz half-widths)"
    if not (low < -1.0 and high > 1.0):
        return "cuts the contact: it must reach beyond -1 and 1 (unit: Hertz half-widths)"
    if not max(-low, high) < FARTHEST:
        return f"is too large: it must stay within {FARTHEST:g} Hertz half-widths"
    return ""


class Options(BaseModel):
    """Numerical choices of a run; the defaults suit a smooth isothermal contact.

    Attributes
    ----------
    points : int or (int, int)
        Nodes per direction (x, y) of the finest grid, ``n 2^k + 1``.
    domain : Domain or "auto"
        ``"auto"`` takes the domain from the Moes load so that its part of the error of the film
        stays below 0.3 %.
    deformation : {"auto", "mlmi", "fft", "lines", "direct"}
        How the elastic deflection is summed; ``"auto"`` takes the cheapest at equal accuracy.
    cycle : {"V", "W", "F"}
        Multigrid cycle.
    pre_sweeps, post_sweeps : int
        Relaxation sweeps before and after the coarse-grid correction; one of them at least.
    wedge_order : {1, 2}
        Order of the upstream difference of the wedge term.
    smoother : {"auto", "fast", "broad", "robust", "gauss-seidel"}
        Setting of the hybrid line relaxation; ``"auto"`` falls back from fast to robust, and from
        broad to robust where heat or shear thinning widen the zone in which the film conducts.
        ``"gauss-seidel"`` is plain point relaxation, which fails at load; kept for teaching.
    accuracy : {"discretisation", "tight", "change"}
        Stop when the estimated iteration error of minimum and central film is below a third of
        the discretisation error, or at ``tolerance`` on residual, change and load. ``"change"``
        stops as much of the literature does, as soon as one cycle changes pressure and temperature
        by little; whether the result may be believed is judged as for ``"discretisation"``.
    tolerance : float
        Limit of the diagonal-scaled residual, the change per cycle and the load error [-].
    max_cycles : int
        Cycles on the finest grid before the solver gives up.
    half_domain : {"auto", "never"}
        ``"auto"`` computes only y >= 0 when the problem is symmetric in y.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    points: Nodes | tuple[Nodes, Nodes] = 257
    domain: Domain | Literal["auto"] = "auto"
    deformation: Literal["auto", "mlmi", "fft", "lines", "direct"] = "auto"
    cycle: Literal["V", "W", "F"] = "V"
    pre_sweeps: Annotated[Count, Field(ge=0, le=10)] = 2
    post_sweeps: Annotated[Count, Field(ge=0, le=10)] = 2
    wedge_order: Literal[1, 2] = 2
    smoother: Literal["auto", "fast", "broad", "robust", "gauss-seidel"] = "auto"
    accuracy: Literal["discretisation", "tight", "change"] = "discretisation"
    tolerance: Annotated[Real, Field(gt=0, lt=1)] = 1e-6
    max_cycles: Annotated[Count, Field(ge=1, le=1000)] = 40
    half_domain: Literal["auto", "never"] = "auto"

    @property
    def shape(self) -> tuple[int, int]:
        """Nodes (ny, nx) of the finest grid."""
        nx, ny = (self.points, self.points) if isinstance(self.points, int) else self.points
        return ny, nx

    @model_validator(mode="after")
    def _must_coarsen(self) -> Self:
        for nodes in self.shape:
            if coarsenings(nodes) < 1:
                fewer, more = coarsenable(nodes)
                raise ValueError(
                    f"points = {nodes} cannot be coarsened: take n 2^k + 1 with 16 <= n <= 31, "
                    f"such as {fewer} or {more} nodes"
                )
        common = min(coarsenings(nodes) for nodes in self.shape)
        if max(self.shape) - 1 > LARGEST_COARSEST * 2**common:
            raise ValueError(
                f"points = {self.points} differ too much: the finer direction may have 4 times the "
                "nodes of the other at most"
            )
        return self

    @model_validator(mode="after")
    def _must_relax(self) -> Self:
        if self.pre_sweeps + self.post_sweeps < 1:
            raise ValueError(
                "pre_sweeps = post_sweeps = 0 leaves nothing that smooths: one of them must be 1 "
                "or more"
            )
        return self


HALVED_TO_CERTIFY = 2
"""How often the grid of a certification is halved; the coarsest must still be halved once."""


def coarsenings(nodes: int) -> int:
    """Return how often a grid line of ``nodes`` can be halved down to 16 to 31 intervals."""
    intervals, count = nodes - 1, 0
    while intervals % 2 == 0 and intervals // 2 >= 16:
        intervals //= 2
        count += 1
    return count if intervals <= 31 else 0


def coarsenable(nodes: int) -> tuple[int, int]:
    """Return the next numbers of nodes up to and above ``nodes`` that can be coarsened."""
    intervals = max(nodes - 1, 32)
    step = 2 ** max(1, (intervals // 16).bit_length() - 1)
    fewer = intervals // step * step
    return fewer + 1, fewer + step + 1


def can_be_halved(options: Options, times: int) -> bool:
    """Return whether a grid of half the intervals, so many times, can be coarsened once more."""
    return min(coarsenings(nodes) for nodes in options.shape) > times


def check_certifiable(options: Options) -> None:
    """Refuse options whose grid cannot be certified.

    Raises
    ------
    InputError
        When the grid cannot be halved twice.
    """
    if not can_be_halved(options, HALVED_TO_CERTIFY):
        raise InputError(
            f"points = {options.points} is too few to certify: the grid is halved twice, "
            "which takes 129 nodes or more per direction"
        )


def check_certifiable_transient(options: Options) -> None:
    """Refuse options of a transient run whose grid cannot be certified, not even by two grids.

    Raises
    ------
    InputError
        When the grid cannot be halved.
    """
    if not can_be_halved(options, 1):
        raise InputError(
            f"points = {options.points} is too few to certify a transient run: the grid is halved, "
            "which takes 65 nodes or more per direction"
        )
