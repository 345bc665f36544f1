"""What follows from a steady solution, each part computed once, when it is first asked for."""

from functools import cached_property

from tehl.post.bodies import Bodies, bodies
from tehl.post.boundary_contact import Touching, touching
from tehl.post.film import mean_film
from tehl.post.heat import Temperature, temperature, work_error
from tehl.post.rolling import Rolling, rolling_friction
from tehl.post.roughness import RoughFilm, rough_film
from tehl.post.starvation import Starvation, starvation
from tehl.post.stress.numbers import StressNumbers, stress_numbers
from tehl.post.summits import LoadSharing, load_sharing
from tehl.post.traction import Traction, traction
from tehl.result.derived import film_loss
from tehl.result.registry import NumbersOf
from tehl.result.solution import CycleReport, Solution


class Following:
    """A solution with all that follows from it, by the names that templates and quantities use."""

    def __init__(self, solution: Solution) -> None:
        self.solution = solution

    @cached_property
    def numbers(self) -> NumbersOf:
        """Its quantities by path (`tehl.result.quantities`)."""
        return NumbersOf(self)

    @cached_property
    def traction(self) -> Traction | None:
        """Traction, None without shear stresses."""
        return traction(self.solution)

    @cached_property
    def rolling(self) -> Rolling | None:
        """Rolling friction of a line contact, None for other shapes."""
        return rolling_friction(self.solution)

    @cached_property
    def film_loss(self) -> float | None:
        """Loss in the film [W]; None where it is not known."""
        return film_loss(self.numbers)

    @cached_property
    def temperature(self) -> Temperature | None:
        """Temperatures, None for an isothermal run."""
        return temperature(self.solution)

    @cached_property
    def bodies(self) -> Bodies | None:
        """Temperatures of the bodies and heat into them, None for an isothermal run."""
        return bodies(self.solution)

    @cached_property
    def rough(self) -> RoughFilm | None:
        """Film between rough surfaces, None where they are smooth or there is no film."""
        return rough_film(self.solution)

    @cached_property
    def load_sharing(self) -> LoadSharing | None:
        """Load of asperities, None without."""
        return load_sharing(self.solution)

    @cached_property
    def touching(self) -> Touching | None:
        """Load where surfaces touch, None without a boundary film."""
        return touching(self.solution)

    @cached_property
    def starvation(self) -> Starvation | None:
        """Numbers of a starved film, None for a flooded one."""
        return starvation(self.solution)

    @cached_property
    def stress(self) -> StressNumbers | None:
        """Largest stresses below the surfaces, None if they were not computed."""
        return stress_numbers(self.solution)

    @cached_property
    def mean_film(self) -> float | None:
        """Mean film over the Hertz contact [m], None where there is no film."""
        return mean_film(self.solution)

    @cached_property
    def work_error(self) -> float | None:
        """What the heat lacks of the power of the surfaces [-], None for an isothermal run."""
        return work_error(self.solution)

    @property
    def finest(self) -> list[CycleReport]:
        """Cycles on the grid of the last one."""
        history = self.solution.history
        return [one for one in history if one.points == history[-1].points]
