"""A piece of a ground tooth that goes on along y: ridges along, across, oblique and at random.

A gear tooth is many times as long as its roughness is coarse, so a piece stands for all of it:
between two mirrors with `ends = "mirrored"`, which takes any heights; again and again with
`ends = "periodic"`, where heights must repeat: a whole number of waves, or a random surface with
`repeat_y`. An oblique lay goes on as it is there; mirrors make zigzags of it, with a thinner film
at a bend.

**Ridges along the flow** guide the oil into the gaps beside them: the film on crests is thinner.

**Ridges across** are flattened one by one as they stand in the contact.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import tehl

HEIGHT = {"type": "wave", "amplitude": "60 nm", "wavelength": "100 um"}
OBLIQUE = HEIGHT | {"angle": "45 deg", "wavelength": f"{100 * 2**0.5} um"}
RANDOM = {"type": "random", "rms": "40 nm", "correlation_length": "30 um", "seed": 2}
SURFACES = {
    "smooth": ({}, "mirrored"),
    "along": (HEIGHT | {"angle": "90 deg"}, "mirrored"),
    "across": (HEIGHT, "mirrored"),
    "oblique": (OBLIQUE, "periodic"),
    "zigzag": (OBLIQUE, "mirrored"),
    "random": (RANDOM | {"repeat_y": "0.2 mm"}, "periodic"),
}


def tooth(roughness: dict[str, object], ends: str) -> tehl.Result:
    """Return the film of a piece of 0.2 mm."""
    return tehl.solve(
        tehl.ContactProblem(
            contact={
                "type": "roller",
                "radius": "10 mm",
                "length": "0.2 mm",
                "ends": ends,
                "hertz_pressure": "0.8 GPa",
                "entrainment_speed": "2 m/s",
            },
            surface_1={"material": "steel"},
            surface_2={"material": "steel"} | ({"roughness": roughness} if roughness else {}),
            lubricant="mineral-oil",
        ),
        tehl.Options(error="2 %"),
    )


def main() -> dict[str, tehl.Result]:
    """Return the films over the kind of roughness."""
    found = {name: tooth(*surface) for name, surface in SURFACES.items()}
    for name, result in found.items():
        central, least = 1e9 * result.film.central, 1e9 * result.film.minimum
        print(f"{name:>7}: central film {central:.0f} nm, minimum {least:.0f} nm")
    return found


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    found = main()
    figure, axes = plt.subplots(len(found), sharex=True, layout="constrained", figsize=(7, 8))
    for ax, (name, result) in zip(axes, found.items(), strict=True):
        drawn = ax.pcolormesh(
            1e3 * result.x, 1e3 * result.y, 1e9 * result.film_thickness, vmin=350, vmax=600
        )
        ax.set(xlim=(-0.3, 0.2), ylabel=f"{name}\ny [mm]")
    figure.colorbar(drawn, ax=axes, label="film [nm]")
    axes[-1].set_xlabel("x [mm]")
    figure.savefig(folder / "ground_tooth.png", dpi=100)
