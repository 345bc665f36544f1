"""What of a case lies at the ends of a roller, or beside the contact."""

from collections.abc import Iterator

from tehl.base.typing import np
from tehl.base.units import percentage
from tehl.contact.roller import ENDS
from tehl.estimate.duration import parts_of
from tehl.estimate.scaling import ScaledProblem

SHARP_END, TOUCHING = 0.5, 0.5
"""Load at an end of a roller over the largest along it, from which on its sharp end carries, and
part of the length that touches below which the cycles do not converge then: 0.56 and 0.68 do, 0.44
and 0.25 do not (dry slices)."""
OPEN_END = 0.7
"""That load from which on an end is expected to press as an edge, with more than 9 Hertz pressures
where it is dry: it does with 0.71 (logarithmic, M = 34), 0.87 (M = 16) and 1 (no profile), and not
with 0.65, that of the template `roller`, which has 6."""


def about_ends(scaled: ScaledProblem) -> Iterator[str]:
    """Yield a roller whose sharp ends carry much.

    Parameters
    ----------
    scaled : ScaledProblem
        Dry slices of its roller are compared.
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
    elif at_end > OPEN_END:
        yield (
            f"a sharp end of the roller carries {percentage(at_end)} of the largest load of its "
            "slices: the pressure there grows with each finer grid; a profile with a larger drop, "
            "less tilt or less load relieves it"
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
