"""Transfers between two levels: the equations of the full approximation scheme (FAS).

Brandt 1977; Venner and Lubrecht 2000, chapters 4 and 6. Each equation A(u) = b becomes

    A_c(u_c) = A_c(I u) + R (b - A(u)),

with I u the injected or weighted fine solution and R full weighting.
"""

import numpy as np

from tehl.kernels import reynolds, transfer
from tehl.operators.transfer import injected
from tehl.solver.cycle.fas import Transfers
from tehl.solver.cycle.level import Level


def restrict(fine: Level, coarse: Level) -> None:
    """Pose the FAS problem of the error of a level on the next coarser one.

    Parameters
    ----------
    fine, coarse : Level
        Unknowns and right-hand sides of the coarser one are written.
    """
    fine.update()
    fine.evaluate_residual()
    restrict_solution(fine, coarse)
    restrict_film(fine, coarse)
    restrict_reynolds(fine, coarse)
    restrict_load(fine, coarse)
    coarse.share.follow_response(fine.share, coarse)
    coarse.is_stale = False  # its film is the injected one, not that of K_c P_c


def restrict_solution(fine: Level, coarse: Level) -> None:
    """Restrict P by full weighting, beside cavities and on edges by injection; rigid motions.

    Coarse nodes of low pressure beside a cavity are frozen: the coarse grid would cavitate them in
    every cycle (Venner and Lubrecht 2000, chapter 6, restrict there by injection).
    """
    mirror, frozen, limit = fine.stencil.mirror, coarse.smoother.frozen, fine.cavity.frozen_below
    transfer.restrict_pressure(fine.film.p, mirror, coarse.film.p)
    transfer.freeze(fine.film.p, fine.smoother.frozen, coarse.film.p, mirror, limit, frozen)
    coarse.is_finest = False
    fine.cavity.inject(fine, coarse)
    # I P and rigid motions: `correct` interpolates the change since
    coarse.correction.pressure[:] = coarse.film.p
    coarse.correction = coarse.correction._replace(rigid=fine.rigid.copy())
    coarse.rigid = fine.rigid.copy()


def restrict_film(fine: Level, coarse: Level) -> None:
    """Pose the film equation:  g_c = I H - K_c P_c - H00 - T Y_c,  I injection.

    The fine film satisfies its equation exactly, so there is no residual to add. Density and
    conductance of the coarse grid follow from the injected film.
    """
    g = coarse.sources.film
    coarse.separation[:] = injected(fine.share.gap(fine), coarse.separation)
    coarse.share.receive(coarse)
    coarse.equations.deformation.deflect(coarse.pressure, g)
    np.subtract(coarse.separation, g, out=g)
    g -= coarse.rigid_film


def restrict_reynolds(fine: Level, coarse: Level) -> None:
    """Pose the Reynolds equation:  f_c = L_c(P_c, H_c) + R (f - L(P, H)),  R full weighting.

    The residual is zero where the fine grid is cavitated: complementarity holds there.
    """
    fine.cavity.restrict(fine, coarse)
    transfer.restrict_residual(fine.sources.residual, fine.stencil.mirror, coarse.sources.residual)
    reynolds.operator(coarse.film, coarse.stencil, coarse.sources.reynolds)
    coarse.sources.reynolds += coarse.sources.residual


def restrict_load(fine: Level, coarse: Level) -> None:
    """Pose the balances:  w_c = sum(P_c) dx_c dy_c + (w - sum(P) dx dy),  moments alike."""
    balances, pressure = coarse.equations.balances, coarse.pressure
    carried = np.append(balances.integral(pressure), balances.moments_of(pressure))
    coarse.sources.load, *moments = fine.missing() + carried
    coarse.sources.moments = np.array(moments)
    coarse.sources.outside = fine.outside_slope


def correct(fine: Level, coarse: Level) -> None:
    """Add the interpolated change  u_c - I u  of the coarse grid, u the pressure and motions.

    By bilinear interpolation, never across the cavitation front: two grids would move the front
    back and forth.

    Parameters
    ----------
    fine, coarse : Level
        The unknowns of the finer one change in place.
    """
    part, limit, before, rigid = coarse.correction
    mirror, now = fine.stencil.mirror, coarse.share.changed(coarse)
    transfer.correct(fine.film.p, now, before, mirror, (part, limit, fine.share.lowest))
    fine.cavity.correct(fine, coarse, before, (part, limit))
    fine.share.take_answer(fine, part * coarse.share.answer(coarse))
    fine.move(part * (coarse.rigid - rigid))


TRANSFERS = Transfers(restrict, correct)
"""Those of a cycle on levels of a contact."""
