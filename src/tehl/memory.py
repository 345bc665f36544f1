"""Memory that a solve takes, and memory that there is."""

import os
from pathlib import Path

from tehl.errors import InputError
from tehl.options import Options, coarsenable
from tehl.problem import ContactProblem

BYTES_PER_NODE = 180
"""Peak memory of a solve by node of the finest full grid, measured; a guide."""

_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Where a container says how much it may take; what it uses holds caches, so it tells nothing."""


BYTES_PER_LAYER, BYTES_COUPLED = 10, 270
"""More of them in a heated or shear-thinning film: per node and layer, and per node."""
USUAL_LAYERS = 9
ANYWHERE = 16e6
"""What a machine that runs Python at all has to spare [byte]; no need to ask it."""


def needed_memory(options: Options, problem: ContactProblem | None = None) -> float:
    """Return the estimated peak memory of a solve [byte]."""
    nodes_y, nodes_x = options.shape
    return float(_bytes_per_node(problem) * nodes_y * nodes_x)


def _bytes_per_node(problem: ContactProblem | None) -> float:
    if problem is None or not problem.is_coupled:
        return BYTES_PER_NODE
    layers = problem.thermal.nodes if problem.thermal else USUAL_LAYERS
    return BYTES_PER_NODE + BYTES_COUPLED + BYTES_PER_LAYER * layers


def available_memory() -> float | None:
    """Return the memory that can still be taken [byte], None where the system does not tell."""
    known = [number for number in (_of_machine(), *map(_of_container, _LIMITS)) if number]
    return min(known, default=None)


def check_memory(options: Options, problem: ContactProblem | None = None) -> None:
    """Refuse a grid that cannot fit into the memory.

    Parameters
    ----------
    options : Options
        With the nodes of the finest grid.
    problem : ContactProblem or None
        What is solved; None for an isothermal film.

    Raises
    ------
    InputError
        If the estimate exceeds what any machine has and the memory that there is; the message names
        a grid that fits.
    """
    needed = needed_memory(options, problem)
    available = available_memory() if needed > ANYWHERE else None
    if available is None or needed <= available:
        return
    largest = int((available / _bytes_per_node(problem)) ** 0.5)
    fitting = f": take {coarsenable(largest)[0]} or fewer" if largest > 33 else ""
    nodes_y, nodes_x = options.shape
    raise InputError(
        f"numerics.points = {nodes_x} x {nodes_y} nodes takes about {needed / 1e9:.2g} GB of "
        f"memory, and {available / 1e9:.2g} GB are available{fitting}"
    )


def _of_machine() -> float | None:
    """Return the memory that no process holds, caches counted as free [byte]."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        facts = dict(line.split(":", 1) for line in lines if ":" in line)
        return 1024.0 * int(facts["MemAvailable"].split()[0])
    except (OSError, ValueError, KeyError, IndexError):
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
