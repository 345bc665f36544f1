"""What happens to the oil in cavities: it is lost there, or it is conserved.

In both P >= 0 (docs/theory/starvation.md). A level has one of them, and asks it where conserving
equations differ: which nodes are partly filled, what coarser grids keep of that, and how the places
where films begin come to rest.
"""

from typing import Protocol

import numpy as np

from tehl.base.typing import Array, BoolArray
from tehl.estimate.grid import Grid
from tehl.kernels import cavities, reynolds, transfer
from tehl.kernels.faces import STEADILY, Stencil
from tehl.kernels.properties import Factors, Film, Heated
from tehl.operators.transfer import injected
from tehl.solver.cycle.equations import Equations, Sources
from tehl.solver.cycle.relaxation import Smoother
from tehl.solver.physics.share import OilAlone

FROZEN_BELOW = 1e-3
"""Pressure below which a coarse node beside a cavity keeps its pressure: where the film ends is
decided on the finest grid alone."""
FRONT_SWEEPS, FRONT_WIDTH, FRONT_RESTS = (4, 16), 6, 0.03
"""Least and most sweeps where a starved film begins, nodes to both sides, and nodes that fill or
empty over the number of lines below which the meniscus is stationary. Least CPU time of 20
contacts (M 20 to 200, r 0.2 to 4, 257 nodes) that all converge."""
MOST_FRONT_CYCLES = 24
"""Most cycles on a coarser grid, where a meniscus must be found: there that costs little."""
OSCILLATES = 4.0
"""Factor on the iteration error of the film that is always accepted where single nodes of a
meniscus oscillate, as it follows these nodes."""
BESIDE_CAVITIES = 2
"""Nodes around partly filled ones that relax with the conductance of the flow: one beyond each
face, and one as they fill and empty."""
MOST_TURNS = 4
"""Times that a node becomes full, or partly filled, after the nodes keep their orders, for what
sliding carries aside: where a film begins nodes would alternate with it. Of the oil of a heated
ball 1e-4 is then not conserved on 49 and 97 nodes, with 2 turns up to 5e-4; without limit the film
does not come to rest."""


class Wetted(Protocol):
    """What a cavity needs of its level (`tehl.solver.cycle.level.Level`)."""

    film: Film
    sources: Sources
    smoother: Smoother
    share: OilAlone
    is_finest: bool
    is_stale: bool

    @property
    def grid(self) -> Grid:
        """The nodes."""

    @property
    def stencil(self) -> Stencil:
        """Weights of the Reynolds operator."""

    @property
    def equations(self) -> Equations:
        """The operators."""

    def update(self) -> None:
        """Evaluate the film."""


class ZeroPressure:
    """Cavities at zero pressure, whose oil is not conserved: complementarity alone."""

    frozen_below = FROZEN_BELOW
    """Pressure below which coarse nodes beside a cavity are frozen [-]."""
    is_balanced = False
    """Whether the flux of oil through sections ends the iteration."""
    most_cycles = 0
    """Least cycles allowed on a coarser grid."""
    oscillates = 1.0
    """Factor on the iteration error of the film that is always accepted [-]."""
    keeps_orders = False
    """Whether the nodes that pass on oil with second order stay, and `full` ones soon do."""

    def extend(self, film: Film) -> Film:
        """Return the fields of a film with those that the cavity needs."""
        return film

    def mark(self, level: Wetted) -> None:
        """Mark what follows from the present film."""

    def limit(self, level: Wetted, factors: Factors | Heated) -> None:
        """Limit the effect of heat and thinning on relaxation where cavities demand it."""

    def held(self, level: Wetted) -> Array:
        """Return the oil at each node after a time step, ``grid.shape`` [-]."""
        return np.asarray(level.film.rho * level.film.h)

    def full(self, level: Wetted) -> BoolArray | None:
        """Return which nodes are full of oil, ``grid.shape``; None where cavities do not matter."""
        del level
        return None

    def inject(self, fine: Wetted, coarse: Wetted) -> None:
        """Give a coarser grid the marks of the finer one, which decides where films begin."""

    def restrict(self, fine: Wetted, coarse: Wetted) -> None:
        """Keep from a coarser grid the residuals that it cannot correct."""

    def correct(
        self, fine: Wetted, coarse: Wetted, before: Array, taken: tuple[float, float]
    ) -> None:
        """Correct where films begin.

        Parameters
        ----------
        fine, coarse : Level
            The pressure of the finer one changes in place.
        before : (ny, nx) array
            Pressure of the coarser one before its cycle.
        taken : (float, float)
            Factor on the correction, and limit of its relative change.
        """

    def settle(self, level: Wetted) -> bool:
        """Let the places where films begin come to rest; return whether they do."""
        del level
        return True


class Conserving(ZeroPressure):
    """Cavities that conserve oil: their nodes are partly filled, and pass on what flows in."""

    frozen_below, is_balanced = 0.0, True
    most_cycles, oscillates = MOST_FRONT_CYCLES, OSCILLATES

    def __init__(self, layer: Array, *, spins: bool) -> None:
        self.layer, self.spins = layer, spins  # oil that enters each line, (ny,)
        self.filled, self.turns = np.zeros((0, 0), bool), np.zeros((0, 0), np.uint8)

    def extend(self, film: Film) -> Film:
        """Return the film with the marks of partly filled nodes and of orders."""
        shape = film.p.shape
        partial, second = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
        held = np.zeros(shape if self.spins else (0, 0))
        return film._replace(partial=partial, second=second, layer=self.layer, held=held)

    def mark(self, level: Wetted) -> None:
        """Mark partly filled nodes, and those that pass on oil with second order."""
        if level.stencil.conserves != STEADILY or not level.is_finest:
            return
        film, stencil = level.film, level.stencil
        scratch = np.empty(film.p.shape if self.spins else (1, film.p.shape[1]))
        cavities.mark_partial(film, stencil, level.sources.reynolds, scratch, level.smoother.ends)
        if not self.keeps_orders:
            set_orders(level)

    def limit(self, level: Wetted, factors: Factors | Heated) -> None:
        """Take no tangents beside partly filled nodes: these pass on the flow that comes."""
        near = around(level.film.partial > 0)
        factors.stretch_x[near] = factors.stretch_y[near] = 1.0

    def held(self, level: Wetted) -> Array:
        """Return the oil at each node after a time step.

        A node without pressure is not full if less oil has come than a full one holds.
        """
        film, stencil, rest = level.film, level.stencil, np.empty(level.grid.shape)
        full = super().held(level)
        reynolds.operator(film, stencil, rest)
        np.subtract(level.sources.reynolds, rest, out=rest)
        missing = np.maximum(rest, 0.0) / stencil.w0
        missing[list(level.grid.edge_rows)] = 0.0
        missing[:, [0, -1]] = 0.0
        return np.where(film.p > 0.0, full, np.maximum(full - missing, 0.0))

    def full(self, level: Wetted) -> BoolArray | None:
        """Return which nodes are full of oil, as they turn a few times at most."""
        if level.stencil.conserves != STEADILY:
            return None
        now = level.film.partial == 0
        if not (self.keeps_orders and self.filled.size):
            self.filled, self.turns = now, np.zeros(now.shape, np.uint8)
        turns = (now != self.filled) & (self.turns < MOST_TURNS)
        self.turns += turns
        self.filled = np.where(turns, now, self.filled)
        return self.filled

    def inject(self, fine: Wetted, coarse: Wetted) -> None:
        """Inject the marks of partly filled nodes."""
        if fine.stencil.conserves == STEADILY:
            coarse.film.partial[:] = injected(fine.film.partial, coarse.film.partial)
            if self.spins:
                coarse.film.held[:] = injected(fine.film.held, coarse.film.held)
            cavities.mark_second_order(coarse.film, coarse.stencil)

    def restrict(self, fine: Wetted, coarse: Wetted) -> None:
        """Keep the residuals of nodes whose coarse neighbour is cavitated."""
        transfer.keep_residual(fine.sources.residual, coarse.film.p, fine.stencil.mirror)

    def correct(
        self, fine: Wetted, coarse: Wetted, before: Array, taken: tuple[float, float]
    ) -> None:
        """Correct the first nodes of films from the coarse nodes behind them."""
        transfer.correct_fronts(fine.film.p, coarse.film.p, before, fine.stencil.mirror, *taken)

    def settle(self, level: Wetted) -> bool:
        """Relax where films begin until these places rest; return whether they do.

        A cycle moves them by some nodes only: coarse grids keep them. The pressure there hardly
        changes the film, which is not evaluated between the sweeps.
        """
        if level.stencil.conserves != STEADILY:
            return True
        (least, most), smoother, film = FRONT_SWEEPS, level.smoother, level.film
        level.update()
        for number in range(most):
            before = film.partial.copy()
            front = FRONT_WIDTH, smoother.frozen, smoother.ends
            cavities.keep_to_fronts(film, level.stencil.mirror, *front)
            level.share.freeze(smoother.frozen)
            smoother.sweep(film, level.stencil, level.sources.reynolds, level.equations.flow)
            self.mark(level)
            moved = np.count_nonzero(film.partial != before)
            rests = bool(moved <= FRONT_RESTS * level.grid.shape[0])
            if rests and number >= least:
                break
        smoother.frozen[:], smoother.ends[:] = 0, level.grid.nx - 1
        level.is_stale = True
        return rests


def around(nodes: BoolArray) -> BoolArray:
    """Return some nodes, and those up to `BESIDE_CAVITIES` around them.

    Parameters
    ----------
    nodes : array of bool, (ny, nx)
        Such as those of cavities.
    """
    for _ in range(BESIDE_CAVITIES):
        grown = nodes.copy()
        for axis in (nodes.T, grown.T), (nodes, grown):
            axis[1][1:] |= axis[0][:-1]
            axis[1][:-1] |= axis[0][1:]
        nodes = grown
    return nodes


def set_orders(level: Wetted) -> None:
    """Set the orders with which the nodes of a level pass on oil."""
    cavities.mark_second_order(level.film, level.stencil)
    level.share.lower(level.film)


def oil_flow(level: Wetted) -> tuple[Array, Array]:
    """Return the oil at each node, rho H or less, and the flux to the east, ``grid.shape``."""
    held, passed = np.empty(level.grid.shape), np.empty(level.grid.shape)
    cavities.oil_flow(secant(level.film), level.stencil, held, passed)
    return held, passed


def secant(film: Film) -> Film:
    """Return a film with the conductances that its flow has.

    Those of a film that thins in shear relax as tangents, with a right-hand side
    (`tehl.solver.cycle.level.Level.write_source`): those are not of the flow.
    """
    eps_y = film.eps * film.across if film.across.size else film.eps
    return film._replace(eps_x=film.eps, eps_y=eps_y)


def cavity_of(equations: Equations) -> ZeroPressure:
    """Return the cavities of a level by its equations."""
    layer = equations.outside.layer
    if layer is None:
        return ZeroPressure()
    return Conserving(layer, spins=equations.entrainment.speed.size > 0)
