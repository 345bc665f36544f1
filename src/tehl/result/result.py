"""Result of a steady solve: its solution, and what follows from it; the error that carries it."""

from dataclasses import dataclass

from tehl.base.errors import TehlError
from tehl.post.boundary_contact import Touching, touching
from tehl.post.heat import Temperature, temperature
from tehl.post.roughness import RoughFilm, rough_film
from tehl.post.starvation import Starvation, starvation
from tehl.post.summits import LoadSharing, load_sharing
from tehl.post.traction import Traction, traction
from tehl.result.saved import Saved
from tehl.result.solution import Solution


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Result(Saved, Solution):
    """Result of one steady solve."""

    @property
    def traction(self) -> Traction | None:
        """Traction coefficients, None without shear stresses."""
        return traction(self)

    @property
    def temperature(self) -> Temperature | None:
        """Temperatures of the film, None for an isothermal run."""
        return temperature(self)

    @property
    def roughness(self) -> RoughFilm | None:
        """Film numbers of rough surfaces, None if no surface states heights or their Sq."""
        return rough_film(self)

    @property
    def load_sharing(self) -> LoadSharing | None:
        """Load and friction of film and asperities, None without asperities finer than the grid."""
        return load_sharing(self)

    @property
    def touching(self) -> Touching | None:
        """Load and friction of film and contact, None without a boundary film."""
        return touching(self)

    @property
    def starvation(self) -> Starvation | None:
        """How far the film is starved, None if no supply is stated."""
        return starvation(self)


class ConvergenceError(TehlError):
    """The solver did not converge; ``result`` is the last finite state, with its history."""

    def __init__(self, message: str, result: Result) -> None:
        super().__init__(message)
        self.result = result

    def __reduce__(self) -> tuple[type["ConvergenceError"], tuple[str, Result]]:
        """Pickle with the result, so that worker processes can raise it."""
        return type(self), (str(self), self.result)
