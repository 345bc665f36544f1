"""Numerical options of a run: the ``[numerics]`` table of a case file."""

import math
import re
from typing import Annotated, ClassVar, Literal, Self

from pydantic import BeforeValidator, ByteSize, Field, model_validator

from tehl.base.errors import InputError
from tehl.base.mistakes import part_of_case
from tehl.base.table import Table
from tehl.base.units import Duration, Share, percentage


def _not_a_boolean(value: object) -> object:
    """Reject true and false, which Python converts to 1 and 0."""
    if isinstance(value, bool):
        raise ValueError("is not a number")
    return value


def _memory(value: object) -> object:
    """Reject what is not an amount of memory."""
    known = isinstance(value, int | float) and 0 < value < 1e18  # not NaN, and no machine has more
    known = known or (isinstance(value, str) and _MEMORY.fullmatch(value) is not None)
    if isinstance(value, bool) or not known:
        raise ValueError('is not an amount of memory, such as "2 GB"')
    return int(value) if isinstance(value, float) else value


_MEMORY = re.compile(r"\s*\d*\.?\d+\s*[kMGT]i?B\s*")
NUMERICS = "numerics"
"""Table of a case that holds its options."""
NO_BOOLEAN = BeforeValidator(_not_a_boolean)
"""Last in an annotation: the JSON schema has the limits of the number inside."""
MOST_NODES_PER_AXIS = 16385
"""Most nodes along one direction."""
Nodes = Annotated[int, Field(ge=17, le=MOST_NODES_PER_AXIS), NO_BOOLEAN]
Sweeps = Annotated[int, Field(ge=0, le=10), NO_BOOLEAN]
Interval = tuple[Annotated[float, NO_BOOLEAN], Annotated[float, NO_BOOLEAN]]
USUAL_ERROR, USUAL_PLAIN_ERROR = 0.01, 0.02
"""Relative error of central and minimum film that is reached by default, and without
extrapolation."""
MOST_STRETCH, LARGEST_COARSEST = 4, 2500
"""Most intervals along one direction over those along the other, and most nodes of the coarsest
grid, which is as different along both where cells are not long: its Newton matrix is dense."""
LEAST_ERROR, LARGEST_ERROR = 1e-4, 0.5
"""Least and largest error that can be asked for."""
LARGEST_DOMAIN_EDGE = 1e3
"""Hertz half-widths within which a domain must stay."""


LINE_WIDTH, ROLLER_ENDS = (-0.5, 0.5), (-1.0, 1.0)
"""Side edges of a line contact: its width of one metre, in units of one metre; and of a roller, in
units of half its length."""


class Domain(Table):
    """Rectangle on which the film is computed, in Hertz half-widths."""

    x: Interval
    y: Interval = LINE_WIDTH
    """Inlet and outlet edge, and the two side edges [-]; a line contact has no side edges."""

    @model_validator(mode="after")
    def _must_contain_the_contact(self) -> Self:
        named = (("x", self.x), ("y", self.y))
        for name, edges in named[: 1 if self.y in (LINE_WIDTH, ROLLER_ENDS) else 2]:
            if fault := _fault_of_edges(*edges):
                raise ValueError(f"{name} = [{edges[0]:g}, {edges[1]:g}]: {fault}")
        return self


def _fault_of_edges(low: float, high: float) -> str:
    """Return what is wrong with two edges of a domain, nothing if they are valid."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return "must be two finite numbers, in Hertz half-widths, such as [-4.5, 1.5]"
    if low >= high:
        return f"must begin with its lower edge: [{high:g}, {low:g}] (unit: Hertz half-widths)"
    if not (low < -1.0 and high > 1.0):
        return "cuts the contact; must reach beyond -1 and 1 (unit: Hertz half-widths)"
    if not max(-low, high) < LARGEST_DOMAIN_EDGE:
        return f"too large; must stay within {LARGEST_DOMAIN_EDGE:g} Hertz half-widths"
    return ""


class Discretisation(Table):
    """Which equations are solved: the error to reach, grid, domain, and order of the wedge."""

    error: Annotated[Share, Field(ge=LEAST_ERROR, le=LARGEST_ERROR)] | None = None
    """Relative error of the central and of the minimum film to reach, such as ``"0.5 %"``;
    left out, it is 1 %, 2 % where the film is not extrapolated; in smooth line
    contacts 0.2 %, with heat or thinning 0.5 %; of rollers 5 %.
    Full multigrid goes on to finer grids until its estimate is below. Between rough surfaces the
    error of the minimum is relative to the central film of the smooth contact."""
    points: Nodes | tuple[Nodes, Nodes | Literal[1]] | Literal["auto"] = "auto"
    """Nodes per direction (x, y) of the finest grid, ``n 2^k + 1``, in line contacts along x: then
    ``error`` is not enforced, and only chooses the domain."""
    extrapolate: bool | None = None
    """Whether the values are of higher order: a wedge of third order, unless ``wedge_order`` is
    stated, and the two finest grids combined, (4 f_h - f_2h) / 3, where they show second order.
    Left out, they are where ``error`` decides the nodes, for steady contacts whose surfaces are
    smooth on the mesh."""
    max_time: Duration = 3600.0
    """Wall time after which no finer grid and no cycle begins, but for a first second. It has to be
    stated to limit solves on stated ``points``, transient runs and repeated passes, which begin
    no further step or pass after it; ``tehl solve --resume`` continues."""
    max_memory: Annotated[ByteSize, Field(gt=0), BeforeValidator(_memory)] | None = None
    """Memory that grids for an ``error`` may need, such as ``"2 GB"``; left out, 1.2 GB, at most
    half of what is free. Stated ``points`` may take all."""
    domain: Domain | Literal["auto"] = "auto"
    """``"auto"`` takes the domain from the Moes load so that it contributes less than 0.3 % to the
    error of the film."""
    edges: Literal["auto", "far_field", "zero"] = "auto"
    """Pressure on the edges of the domain: that of the far field, or zero as in much of the
    literature; ``"auto"`` takes the far field unless ``domain`` is stated."""
    wedge_order: Literal[1, 2, 3] | None = None
    """Order of the upstream difference of the wedge term; with 3 the conductance between two nodes
    is their geometric mean too. Left out, it is 3 where ``extrapolate`` holds, along rollers and
    smooth lines, and where the error decides the nodes of rough contacts and runs, else 2."""

    @property
    def shape(self) -> tuple[int, int]:
        """Nodes (ny, nx) of the finest grid, if they are stated."""
        assert self.points != "auto"
        nx, ny = (self.points, self.points) if isinstance(self.points, int) else self.points
        return ny, nx

    @property
    def order(self) -> int:
        """Order of the wedge."""
        return self.wedge_order or (3 if self.extrapolate else 2)

    @property
    def target(self) -> float:
        """Relative error of the film to reach, or for which the domain is chosen [-]."""
        usual = USUAL_ERROR if self.extrapolate else USUAL_PLAIN_ERROR
        return usual if self.error is None else self.error

    def on_points(self, nx: int, ny: int) -> Self:
        """Return these options with the nodes ``nx``, ``ny`` stated.

        An error stays, as the domain follows from it, and does not contradict them.

        Parameters
        ----------
        nx, ny : int
            Nodes along and across the entrainment, those of the whole domain.
        """
        found = self.model_copy(update={"points": (nx, ny)})
        found.model_fields_set.discard("points")
        return found

    @property
    def has_far_field(self) -> bool:
        """Whether the edges have the pressure of the far field."""
        return self.edges == "far_field" or (self.edges == "auto" and self.domain == "auto")

    @model_validator(mode="after")
    def _must_coarsen(self) -> Self:
        if self.points == "auto":
            return self
        rows, columns = self.shape
        lines = (columns,) if rows == 1 else (rows, columns)
        for nodes in lines:
            if coarsenings(nodes) < 1:
                fewer, more = coarsenable(nodes)
                raise ValueError(
                    f"points = {nodes}: cannot be coarsened; take n 2^k + 1 with 16 <= n <= 31 "
                    f"and k >= 1, such as {fewer} or {more} nodes"
                )
        if max(lines) - 1 > MOST_STRETCH * (min(lines) - 1):
            raise ValueError(
                f"points = {self.points}: too different along x and y; one direction may have at "
                f"most {MOST_STRETCH} times the intervals of the other"
            )
        common = min(map(coarsenings, lines))
        coarsest = math.prod((nodes - 1 >> common) + 1 for nodes in lines)
        if coarsest > LARGEST_COARSEST:
            raise ValueError(
                f"points = {self.points}: the coarsest grid would have {coarsest} nodes, "
                f"{LARGEST_COARSEST} at most; take more nodes along the shorter direction"
            )
        return self


@part_of_case(NUMERICS, NUMERICS)
class Options(Discretisation):
    """Numerical options of a run: its equations, and how they are solved.

    The defaults suit a smooth isothermal contact.
    """

    synonyms: ClassVar = {
        "points": "nodes n grid mesh nx ny",
        "error": "precision relative_error",
        "max_cycles": "iterations max_iterations cycles",
        "max_time": "timeout time_limit",
    }

    deformation: Literal["auto", "mlmi", "fft", "lines", "direct"] = "auto"
    """Method for the elastic deflection; ``"auto"`` takes the cheapest, of those that are
    exact to rounding if ``accuracy = "tight"``."""
    cycle: Literal["V", "W", "F"] = "V"
    """Multigrid cycle."""
    pre_sweeps: Sweeps = 2
    post_sweeps: Sweeps = 2
    """Relaxation sweeps before and after the coarse-grid correction, at least one together."""
    smoother: Literal["auto", "fast", "broad", "robust", "gauss-seidel"] = "auto"
    """Setting of the hybrid line relaxation; ``"auto"`` falls back from fast to robust, and from
    broad to robust where heat or shear thinning widen the zone in which the film conducts.
    ``"gauss-seidel"`` is plain point relaxation, for teaching; it diverges in loaded contacts."""
    accuracy: Literal["discretisation", "tight", "change"] = "discretisation"
    """``"discretisation"`` stops when the estimated iteration error of minimum and central film is
    below a third of the discretisation error, ``"tight"`` at ``tolerance``. ``"change"`` stops, as
    much of the literature does, as soon as one cycle changes pressure and temperature by little;
    the result is judged as for ``"discretisation"``."""
    tolerance: Annotated[float, Field(gt=0, lt=1), NO_BOOLEAN] = 1e-6
    """Limit of the diagonal-scaled residual, the change per cycle and the load error [-]."""
    max_cycles: Annotated[int, Field(ge=1, le=1000), NO_BOOLEAN] = 40
    """Largest number of cycles on the finest grid."""
    half_domain: Literal["auto", "never"] = "auto"
    """``"auto"`` computes only y >= 0 if the problem is symmetric in y."""

    @model_validator(mode="after")
    def _must_relax(self) -> Self:
        if self.pre_sweeps + self.post_sweeps < 1:
            raise ValueError(
                "pre_sweeps = post_sweeps = 0: the cycle has no relaxation; one of them must be 1 "
                "or more"
            )
        return self


def check_nodes(options: Options) -> None:
    """Raise InputError if a user states both the error to reach and the nodes."""
    both = {"error", "points"} <= options.model_fields_set
    if both and options.error is not None and options.points != "auto":
        raise InputError(
            f"numerics.error = {percentage(options.error)} and numerics.points are both stated: "
            'the error decides the number of nodes; remove one, or set numerics.points = "auto"'
        )


def coarsenings(nodes: int) -> int:
    """Return the number of halvings of a line of ``nodes`` to 16 to 31 intervals, 0 if none."""
    intervals, count = nodes - 1, 0
    while intervals % 2 == 0 and intervals // 2 >= 16:
        intervals //= 2
        count += 1
    return count if intervals <= 31 else 0


def coarsenable(nodes: int) -> tuple[int, int]:
    """Return the nearest two numbers of nodes that can be coarsened, up to and above ``nodes``."""
    intervals = max(nodes - 1, 32)
    step = 2 ** max(1, (intervals // 16).bit_length() - 1)
    fewer = intervals // step * step
    return fewer + 1, fewer + step + 1


def can_be_halved(options: Options, times: int) -> bool:
    """Whether the grid, its intervals halved ``times`` times, still has a coarser grid.

    Parameters
    ----------
    options : Options
        With ``points`` stated: "auto" has no shape.
    times : int
        Halvings of the intervals along x and y.
    """
    return min(coarsenings(nodes) for nodes in options.shape if nodes > 1) > times


def check_certifiable(options: Options, *, transient: bool = False) -> None:
    """Check that the grid can be halved for error bars: twice, in a transient run once.

    Parameters
    ----------
    options : Options
        With the nodes of the finest grid stated.
    transient : bool
        Whether the run is transient, and 65 nodes per direction suffice instead of 129.

    Raises
    ------
    InputError
        If the grid has too few nodes.
    """
    halvings, what, least = (1, " a transient run", 65) if transient else (2, "", 129)
    if not can_be_halved(options, halvings):
        raise InputError(
            f"numerics.points = {options.points}: too few to certify{what}, which halves the grid "
            f"{'once' if transient else 'twice'}; take {least} nodes or more per direction"
        )
