"""Memory that a solve needs, and memory that is available, before and during the solve."""

import math
import os
import re
from pathlib import Path

from tehl.base.errors import InputError
from tehl.contact.options import Options, coarsenable
from tehl.contact.problem import ContactProblem
from tehl.estimate.settled import crowds_at_ends

BYTES_PER_NODE = 220
"""Measured peak memory of an isothermal Newtonian solve per node of the finest full grid."""
BYTES_COUPLED, BYTES_HEATED, BYTES_PER_LAYER = 270, 110, 10
"""Added by heat or shear thinning, and by heat: per node, and per node and layer across the film.
Thinning contacts on 769 x 1537 nodes took 570 and 580, on 769 x 769 nodes 600, heated ones on
513 x 1025 and 641 x 641 nodes 660 and 680."""
BYTES_ASPERITIES = 70
"""Added by asperities: heated contacts on 769 x 769 nodes take 750 with and 675 without."""
RESTING_PART = 0.55
"""Part of its memory that a grid keeps while another is tried: of two heated ones 0.28 and 0.33, of
an isothermal one 0.55."""
USABLE_MEMORY_PART, USUAL_MEMORY = 0.5, 1.2e9
"""Part of the free memory that a solve takes unasked, and most [byte]: so the process stays below
1.5 GB."""
BYTES_CROWDED = 1500
"""Added per stored node where lines crowd at ends: 240 to 540 by near lines of the finest grid, of
1025 x 513 nodes, and twice that by the coarser ones, 840 to 1520 in all."""

_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Memory limit of a container. Its usage is not read: it counts caches that can be dropped."""


def needed_memory(
    options: Options, problem: ContactProblem | None = None, *, crowds: bool = True
) -> float:
    """Return the estimated peak memory of a solve [byte].

    Parameters
    ----------
    options : Options
        With the nodes of the finest grid stated.
    problem : ContactProblem or None
        Heat and time steps need more arrays per node; None is an isothermal steady film.
    crowds : bool
        Whether lines crowd at the ends of a roller that may have them so.
    """
    nodes_y, nodes_x = options.shape
    found = float(_bytes_per_node(problem) * nodes_y * nodes_x)
    if crowds and problem is not None and crowds_at_ends(problem):
        stored = (nodes_y + 1) // 2 if problem.is_even_in_y else nodes_y
        found += BYTES_CROWDED * nodes_x * stored
    return found


def _bytes_per_node(problem: ContactProblem | None) -> float:
    if problem is None:
        return BYTES_PER_NODE
    plain = BYTES_PER_NODE + (BYTES_ASPERITIES if problem.asperities is not None else 0)
    if not problem.is_coupled:
        return plain
    heat = problem.heat
    heated, layers = (0, 9) if heat is None else (BYTES_HEATED, heat.layers)
    return plain + BYTES_COUPLED + heated + BYTES_PER_LAYER * layers


def available_memory() -> float | None:
    """Return the memory available to this process [byte], None if unknown."""
    known = [number for number in (_of_machine(), *map(_of_container, _LIMITS)) if number]
    return min(known, default=None)


def memory_limit(options: Options) -> float:
    """Return the memory that a solve may take where its error decides the nodes [byte]."""
    if options.max_memory is not None:
        return float(options.max_memory)
    return min(USABLE_MEMORY_PART * (available_memory() or math.inf), USUAL_MEMORY)


def check_memory(options: Options, problem: ContactProblem | None = None) -> None:
    """Check that the finest grid fits into the available memory.

    Parameters
    ----------
    options : Options
        Nodes that it does not state are fitted into the memory.
    problem : ContactProblem or None
        As of :func:`needed_memory`.

    Raises
    ------
    InputError
        If the need exceeds the available memory; the message names a grid that fits.
    """
    if options.points == "auto":
        return
    needed = needed_memory(options, problem)
    # any machine that runs Python has 16 MB
    available = available_memory() if needed > 16e6 else None
    if available is None or needed <= available:
        return
    largest = int((available / _bytes_per_node(problem)) ** 0.5)
    fitting = f"; take {coarsenable(largest)[0]} or fewer" if largest > 33 else ""
    nodes_y, nodes_x = options.shape
    raise InputError(
        f"numerics.points = {nodes_x} x {nodes_y}: needs about {needed / 1e9:.2g} GB of memory, "
        f"but {available / 1e9:.2g} GB are available{fitting}"
    )


def _of_machine() -> float | None:
    """Return the free memory of the machine, caches counted as free [byte]."""
    try:
        found = re.search(
            r"MemAvailable:\s*(\d+)", Path("/proc/meminfo").read_text(encoding="ascii")
        )
        if found is not None:
            return 1024.0 * int(found[1])
    except (OSError, ValueError):
        pass
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (OSError, ValueError, AttributeError):
        return None


def _of_container(file: str) -> float | None:
    """Return the limit of a control group [byte], None without one."""
    try:
        limit = int(Path(file).read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None
    return float(limit) if 0 < limit < 2**60 else None
