"""The film between rough surfaces as rows of tables."""

import math
from collections.abc import Iterable, Iterator

from tehl.post.micro_film import RoughnessEffect
from tehl.post.roughness import RoughFilm
from tehl.post.waviness import WaveResponse
from tehl.result import Result

WAVE_HEAD = (
    "wave", "at", "amplitude", "nodes on it", "left in the film", "theory",
    "pressure", "theory", "flattens it", "streaks from the inlet",
)  # fmt: skip
WAVE_NOTE = (
    "Fitted where |X|, |Y| < 0.4. Theory is linear and that of a wave which stands in a film of "
    "constant thickness and temperature, of Newtonian oil: other films have none beside them. "
    "Crests along the entrainment are left to the inlet, of which it knows nothing. Waves of "
    "measured and random surfaces are listed where they stand out of the heights."
)
_TOLD = (0.01, 0.5, 0.99)


def film_rows(found: RoughFilm) -> Iterator[tuple[str, str, str]]:
    """Yield name, value and remark of each number of a rough film."""
    first, second = found.sq
    together = f"surface 1: {_nm(first)}, surface 2: {_nm(second)}"
    yield "Sq of both surfaces", _nm(found.composite), together
    formula = f"{found.lambda_by_formula:.3g} with the smooth film by formula"
    yield "lambda ratio", f"{found.lambda_ratio:.3g}", f"mean film in the middle over Sq; {formula}"
    for part, film in found.quantiles:
        if part in _TOLD:
            yield f"{100 * part:.0f} % of the contact", _nm(film), "have a thinner film"
    yield "thinner than Sq", _percent(found.below_composite), "of the Hertz contact"
    yield "thinner than half the median", _percent(found.below_half), "of the Hertz contact"
    x, y = found.minimum_at
    yield "minimum film", f"X = {x:.3g}, Y = {y:.3g}", "in Hertz half-widths"
    yield "largest pressure", f"{found.largest_pressure:.4g}", "Hertz pressures"
    for axis, ripples in (("x", found.ripples_x), ("y", found.ripples_y)):
        depth = f"{_nm(ripples.depth)} deep on average" if ripples.count else ""
        yield f"valleys along {axis}", str(ripples.count), depth


def wave_rows(waves: Iterable[WaveResponse]) -> Iterator[tuple[str, ...]]:
    """Yield a row for each wave, as ``WAVE_HEAD`` has it."""
    for wave in waves:
        theory = wave.theory
        told = not theory.left_to_inlet
        yield (
            _nm(wave.wavelength),
            f"{math.degrees(wave.angle) + 0.0:.3g}°",
            _nm(wave.amplitude),
            f"{wave.points_per_wave:.3g}",
            f"{_nm(wave.film_amplitude)} ({_percent(wave.film_ratio)})",
            _percent(theory.film_ratio) if told and theory.film_ratio is not None else "",
            _mpa(wave.pressure_amplitude),
            _mpa(theory.pressure) if told and theory.pressure is not None else "",
            _mpa(theory.elastic_pressure),
            _nm(wave.carried_amplitude) if wave.carried_amplitude > 0 else "",
        )


def effect_rows(result: Result, effect: RoughnessEffect) -> Iterator[tuple[str, str, str, str]]:
    """Yield what roughness does: name, with it, without it, and their ratio."""
    film = result.film
    yield (
        "central film",
        _nm(film.central),
        _nm(effect.smooth_central),
        f"{effect.central:.4f}",
    )
    yield (
        "minimum film",
        _nm(film.minimum),
        _nm(effect.smooth_minimum),
        f"{effect.minimum:.4f}",
    )
    yield "mean film in the middle", "", "", f"{effect.middle:.4f}"
    highest = float(result.pressure.max())
    yield (
        "largest pressure",
        _mpa(highest),
        _mpa(effect.smooth_largest_pressure),
        f"{effect.largest_pressure:.4f}",
    )
    if effect.traction is not None:
        yield "traction at mid-film", "", "", f"{effect.traction:.4f}"
    yield "ripple of the film, rms", _nm(effect.ripple_film), "", ""
    yield "ripple of the pressure, rms", _mpa(effect.ripple_pressure), "", ""


def _nm(metres: float) -> str:
    return f"{metres * 1e9:.4g} nm" if metres < 1e-6 else f"{metres * 1e6:.4g} µm"


def _mpa(pressure: float) -> str:
    return f"{pressure * 1e-6:.4g} MPa"


def _percent(part: float) -> str:
    return f"{100 * part:.3g} %"
