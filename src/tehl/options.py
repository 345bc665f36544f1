"""How hard to try: the numerical choices of a run, the ``[numerics]`` table of a case file."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

Interval = tuple[float, float]


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
        for name, (low, high) in (("x", self.x), ("y", self.y)):
            if not (low < -1.0 and high > 1.0 and abs(low) < 1e3 and abs(high) < 1e3):
                raise ValueError(
                    f"{name} = [{low:g}, {high:g}] cuts the contact: it must reach beyond "
                    "-1 and 1 (unit: Hertz half-widths)"
                )
        return self


class Options(BaseModel):
    """Numerical choices of a run; the defaults suit a smooth isothermal contact.

    Attributes
    ----------
    points : int or (int, int)
        Nodes per direction (x, y) of the finest grid, ``n 2^k + 1``.
    domain : Domain or "auto"
        ``"auto"`` takes the domain from the Moes load so that its part of the error of the film
        stays below 0.3 %.
    deformation : {"auto", "mlmi", "fft", "direct"}
        How the elastic deflection is summed; ``"auto"`` takes the cheaper at equal accuracy.
    cycle : {"V", "W", "F"}
        Multigrid cycle.
    pre_sweeps, post_sweeps : int
        Relaxation sweeps before and after the coarse-grid correction.
    wedge_order : {1, 2}
        Order of the upstream difference of the wedge term.
    smoother : {"auto", "fast", "robust", "gauss-seidel"}
        Setting of the hybrid line relaxation; ``"auto"`` falls back from fast to robust.
        ``"gauss-seidel"`` is plain point relaxation, which fails at load; kept for teaching.
    accuracy : {"discretisation", "tight"}
        Stop when the estimated iteration error of minimum and central film is below a third of
        the discretisation error, or at ``tolerance`` on residual, change and load.
    tolerance : float
        Limit of the diagonal-scaled residual, the change per cycle and the load error [-].
    max_cycles : int
        Cycles on the finest grid before the solver gives up.
    half_domain : {"auto", "never"}
        ``"auto"`` computes only y >= 0 when the problem is symmetric in y.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    points: (
        Annotated[int, Field(ge=17, le=16385)]
        | tuple[Annotated[int, Field(ge=17, le=16385)], Annotated[int, Field(ge=17, le=16385)]]
    ) = 257
    domain: Domain | Literal["auto"] = "auto"
    deformation: Literal["auto", "mlmi", "fft", "direct"] = "auto"
    cycle: Literal["V", "W", "F"] = "V"
    pre_sweeps: Annotated[int, Field(ge=0, le=10)] = 2
    post_sweeps: Annotated[int, Field(ge=0, le=10)] = 2
    wedge_order: Literal[1, 2] = 2
    smoother: Literal["auto", "fast", "robust", "gauss-seidel"] = "auto"
    accuracy: Literal["discretisation", "tight"] = "discretisation"
    tolerance: Annotated[float, Field(gt=0, lt=1)] = 1e-6
    max_cycles: Annotated[int, Field(ge=1, le=1000)] = 40
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
        return self


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
