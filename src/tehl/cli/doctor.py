"""``tehl doctor``: what is installed, whether it works, and compiling ahead of time."""

import json
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from tehl.base.lazy import lazy
from tehl.cli.arguments import AsJson
from tehl.cli.ending import ENVIRONMENT
from tehl.cli.lazily import kernel_cache, numerics, problems, results, samples, solvers, store

if TYPE_CHECKING:
    from tehl.api.problem import ContactProblem
    from tehl.api.results import Result
    from tehl.cli import progress as live
else:
    live = lazy("tehl.cli.progress")

PACKAGES = (
    *("tehl", "numpy", "scipy", "numba", "llvmlite", "pydantic", "typer", "rich", "xarray"),
    *("h5netcdf", "h5py", "matplotlib"),
)
KNOWN_CENTRAL_FILM = 0.4270310700955564
"""H at the centre for M = 20, L = 10, alpha p_h = 9.89, on 129 x 129 nodes: a Newton solver."""
_STEEL = {"young_modulus": 2.06e11, "poisson_ratio": 0.3}
_CASE: dict[str, Any] = {
    "title": "Self-check",
    "contact": {"radius": 0.02, "moes_load": 20.0, "moes_speed": 10.0},
    "surface_1": {"material": _STEEL},
    "surface_2": {"material": _STEEL},
    "lubricant": {
        "viscosity": {"law": "roelands", "eta_0": 0.04, "alpha": 22e-9},
        "density": {"law": "dowson-higginson", "rho_0": 890.0},
    },
}
"""The contact whose film is known."""


class Check(NamedTuple):
    """What a check found, and whether it passed."""

    found: str
    passed: bool


def doctor(
    warm: Annotated[
        bool, typer.Option("--warm", help="Compile all kernels now, so that no solve has to.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Show versions and the kernel cache, and check the package against known numbers.

    The checks compile the kernels if they are cold. Exit code 3 if one fails.
    """
    facts = dict(_facts())
    if not as_json:
        _show(facts)
    if warm:
        typer.echo("compiling all kernels", err=True)
        _warm()
    checks = {name: _checked(check) for name, check in _CHECKS.items()}
    if as_json:
        found = {name: check._asdict() for name, check in checks.items()}
        typer.echo(json.dumps({**facts, "checks": found}))
    else:
        _show({n: f"{'ok' if c.passed else 'FAILED'}: {c.found}" for n, c in checks.items()})
    if not all(check.passed for check in checks.values()):
        raise typer.Exit(ENVIRONMENT)


def _show(rows: dict[str, str]) -> None:
    for name, value in rows.items():
        typer.echo(f"{name:<18} {value}")


def _facts() -> Iterator[tuple[str, str]]:
    """Yield what this installation is, by name."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    yield "python", f"{platform.python_version()} ({platform.python_implementation()})"
    yield "platform", platform.platform()
    for name in PACKAGES:
        try:
            yield name, version(name)
        except PackageNotFoundError:
            yield name, "missing"
    yield "kernel cache", str(kernel_cache.folder() or "none: no folder can be written")
    for name, coupled in (("isothermal", False), ("with heat", True)):
        cold = kernel_cache.is_cold(coupled=coupled)
        yield f"kernels, {name}", "compiled by the first solve" if cold else "compiled"


def _warm() -> None:
    """Compile all kernels, also those that few films need."""
    live.compile_kernels(coupled=True)
    for sample in samples.RARE:
        sample.compile()


def _problem() -> "ContactProblem":
    return problems.ContactProblem.model_validate(_CASE)


def _solved() -> "Result":
    domain = numerics.Domain(x=(-4.5, 1.5), y=(-3.0, 3.0))
    exact = numerics.Options(
        points=129, domain=domain, deformation="fft", accuracy="tight", tolerance=1e-8
    )
    return solvers.solve(_problem(), exact)


# ---- checks


def _checked(check: Callable[[], Check]) -> Check:
    """Run a check; an exception is its finding."""
    try:
        return check()
    except Exception as error:
        return Check(f"{type(error).__name__}: {error}", passed=False)


def _hertz() -> Check:
    """Check the dry contact of a sphere against ``a^3 = 3 w R / (2 E')``."""
    problem = _problem()
    cube = 1.5 * problem.load * problem.radius_x / problem.reduced_modulus
    error = abs(problem.hertz.half_width_x**3 / cube - 1.0)
    return Check(f"error {error:.1e}", passed=error < 1e-9)


def _film() -> Check:
    """Check a small solve against an independent solver on the same grid."""
    error = abs(_solved().film_scaled.central / KNOWN_CENTRAL_FILM - 1.0)
    return Check(f"relative error of the central film {error:.0e}", passed=error < 1e-6)


def _storage() -> Check:
    """Check that a stored result comes back bit by bit."""
    import tempfile
    from pathlib import Path

    import numpy as np

    result = _solved()
    with tempfile.TemporaryDirectory() as folder:
        store.save(result, Path(folder) / "check.nc")
        back = results.load_as(results.Result, Path(folder) / "check.nc")
    same = np.array_equal(back.scaled.film, result.scaled.film)
    return Check("bit by bit" if same else "fields differ", passed=same)


_CHECKS = {"Hertz contact": _hertz, "film, 129 x 129": _film, "storage": _storage}
