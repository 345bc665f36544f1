"""What of a case lies at the ends of a roller, or beside the contact."""

from collections.abc import Iterator

from tehl.base.typing import np
from tehl.base.units import percentage
from tehl.contact.options import Options
from tehl.contact.roller import ENDS
from tehl.estimate.duration import parts_of
from tehl.estimate.nodes import finest_grid, planned
from tehl.estimate.scaling import ScaledProblem
from tehl.operators.dry import EDGE, end_pressure

SHARP_END, TOUCHING = 0.5, 0.5
"""Load at an end of a roller over the largest along it, from which on its sharp end carries, and
part of the length that touches below which the cycles do not converge then: 0.56 and 0.68 do, 0.44
and 0.25 do not (dry slices)."""


def about_ends(scaled: ScaledProblem, options: Options) -> Iterator[str]:
    """Yield a roller whose sharp ends carry much.

    Parameters
    ----------
    scaled, options : ScaledProblem, Options
        Slices of its roller are compared, and its dry pressure on short cells.
    """
    roller, hertz = scaled.groups.roller, scaled.problem.hertz
    if roller is None or roller.goes_on:
        return
    part, most = roller.loaded_part, roller.widest
    at_end = max(roller.share(np.array(ENDS))) / most**2
    if part < TOUCHING and at_end > SHARP_END:
        pressure = hertz.pressure * most / 1e9
        yield (
            f"the roller touches on about {percentage(part)} of its length, up to its sharp end, "
            f"at more than {pressure:.2g} GPa: a run may take minutes and not converge; check "
            "tilt or moment and load"
        )
        return
    at_end = end_pressure(finest_grid(scaled, planned(scaled, options)), scaled.groups)
    if at_end > EDGE:
        yield (
            f"a sharp end of the roller presses with {at_end:.2g} p_h or more where it is dry: the "
            "pressure there grows with each finer grid; a profile with a larger drop, or of "
            "lundberg, less tilt or less load relieves it"
        )


def about_places(scaled: ScaledProblem) -> Iterator[str]:
    """Yield features of a steady contact that lie beside it.

    Parameters
    ----------
    scaled : ScaledProblem
        A transient run refuses those that do not enter.
    """
    for part in parts_of(scaled) if scaled.problem.transient is None else ():
        if not part.is_in_contact(scaled.scales, 0.0, None):
            kind = getattr(part.roughness, "type", "roughness")
            yield f"{part.surface}.roughness: the {kind} lies beside the contact; check x and y"
