"""Options of a solve, settled by the kind of contact: order, error to reach and extrapolation."""

from tehl.base.errors import InputError
from tehl.contact.options import LINE_WIDTH, ROLLER_ENDS, Options
from tehl.contact.problem import ContactProblem
from tehl.estimate.line import HEATED_LINE_ERROR, LINE_ERROR

ROLLER_ERROR = 0.05
"""Relative error of the film of a roller that is reached by default: at its ends the smallest film
changes by some percent with each finer grid."""


def settled(problem: ContactProblem, options: Options) -> Options:
    """Return ``options`` that say whether the film of a contact is extrapolated.

    Waves of rough surfaces, nodes that touch and time steps do not show one order.

    Parameters
    ----------
    problem : ContactProblem
        Smooth steady films without boundary contact are extrapolated if the grid is chosen too.
    options : Options
        Returned as they are if they state ``extrapolate``.
    """
    if problem.contact.is_line:
        return _of_one_row(problem, options)
    if problem.contact.has_lines:
        options = _between_ends(problem, options)
    if options.domain != "auto" and options.domain.y == LINE_WIDTH:
        raise InputError("numerics.domain.y is missing: give the side edges, such as [-3.0, 3.0]")
    if isinstance(options.points, tuple) and options.points[1] == 1:
        raise InputError('numerics.points: one row of nodes is for contact.type = "line" alone')
    if options.extrapolate is not None:
        return options
    found = options.points == "auto" and is_smooth(problem)
    return options.model_copy(update={"extrapolate": found})


def raises_order(problem: ContactProblem, options: Options) -> bool:
    """Return whether a contact that is rough or varies in time has a wedge of third order.

    As its steady smooth film has; rollers have it by `settled`. Two grids of second order that
    resolve the heights differ by much of the error of the film: of 47 random contacts four more
    reach 2 %, and most take less time. In time the film that keeps its own wedge follows the
    present one (`tehl.solver.transient.oil`): 65 nodes err as 257 of second order do. Where it does
    not, as of conserved oil, the error is a third to a thirtieth of that of second order. A point
    contact with boundary contact has the geometric means of the conductance that belong to that
    wedge, and its fluxes keep second order: it errs by half as much, in time too. Lines that touch
    do not converge with these.

    Parameters
    ----------
    problem : ContactProblem
        Rough or smooth, steady or not, with boundary contact or without.
    options : Options
        Those that state nodes or an order keep it.
    """
    touches, kind = problem.contact_film is not None, problem.contact
    is_free = options.points == "auto" and options.wedge_order is None
    varies = problem.transient is not None or problem.is_rough or touches
    return is_free and varies and (not kind.has_lines or (kind.is_line and not touches))


def keeping_order(problem: ContactProblem, options: Options, stated: Options) -> Options:
    """Return options that state the nodes of a solve, with the order of the wedge it began with.

    Parameters
    ----------
    problem : ContactProblem
        Of the solve.
    options, stated : Options
        Those of the solve, and the same with its nodes, which alone have a wedge of second order:
        with it the smooth reference of the template ``rough`` is 1.2 % too thin.
    """
    order = 3 if raises_order(problem, options) else options.wedge_order
    return stated.model_copy(update={"wedge_order": order})


def _between_ends(problem: ContactProblem, options: Options) -> Options:
    """Return the options of a roller, whose domain ends where it does.

    At its ends the pressure is steep, and the film does not show one order. The wedge is of third
    order, between rough surfaces and in time too: the middle of second order errs forty times as
    much.
    """
    domain = options.domain
    changes: dict[str, object] = {"extrapolate": bool(options.extrapolate)}
    is_free = options.wedge_order is None and options.extrapolate is None
    if is_free and problem.contact_film is None:
        changes["wedge_order"] = 3
    if options.error is None and options.points == "auto" and not problem.shape.goes_on:
        changes["error"] = ROLLER_ERROR
    options = options.model_copy(update=changes)
    if domain == "auto" or domain.y == ROLLER_ENDS:
        return options
    if domain.y != LINE_WIDTH:
        raise InputError(
            "numerics.domain.y: the nodes of a roller end where it does; state domain.x alone"
        )
    return options.model_copy(update={"domain": domain.model_copy(update={"y": ROLLER_ENDS})})


def _of_one_row(problem: ContactProblem, options: Options) -> Options:
    """Return the options of a line contact, whose nodes lie on one row.

    They are cheap, so no film is extrapolated; the wedge is of third order where that of an
    extrapolated film would be.
    """
    points, domain = options.points, options.domain
    if isinstance(points, tuple) and points[1] != 1:
        raise InputError(
            f"numerics.points = {list(points)}: a line contact has nodes along x alone; take "
            f"{points[0]}"
        )
    changes: dict[str, object] = {"extrapolate": bool(options.extrapolate)}
    is_free = options.wedge_order is None and options.extrapolate is None
    # where the error decides the nodes of a transient run, second order stays behind it
    decided = problem.transient is not None and points == "auto"
    if is_free and not (_is_uneven(problem) or decided):
        changes["wedge_order"] = 3
    if options.error is None and points == "auto" and is_smooth(problem):
        changes["error"] = HEATED_LINE_ERROR if problem.is_coupled else LINE_ERROR
    if isinstance(points, int):
        changes["points"] = (points, 1)
    if domain != "auto" and domain.y != LINE_WIDTH:
        changes["domain"] = domain.model_copy(update={"y": LINE_WIDTH})
    return options.model_copy(update=changes)


def crowds_at_ends(problem: ContactProblem) -> bool:
    """Return whether the lines of the grid crowd at the ends of a roller.

    Dynamics need uniform ones, and the film at the sharp ends of a straight roller has no limit to
    resolve: only a film under a profile has crowded ones, steady or in time.
    """
    return problem.contact.profile is not None and problem.dynamics is None


def _is_uneven(problem: ContactProblem) -> bool:
    """Whether heights or boundary contact make a film uneven on the mesh."""
    return problem.is_rough or problem.contact_film is not None


def is_smooth(problem: ContactProblem) -> bool:
    """Whether a steady film is smooth on the mesh."""
    return not _is_uneven(problem) and problem.transient is None
