"""Laws of packages that are installed beside tehl, in a process of their own."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import tehl
from tehl import cli
from tehl.base.errors import FileFormatError, InputError

EXAMPLE = Path(__file__).parents[2] / "examples" / "own_law"
TWINS = """
from typing import Literal
from tehl.lubricant import Barus, DowsonHigginson, Limiting

class TwinViscosity(Barus):
    law: Literal["twin-viscosity"] = "twin-viscosity"

class TwinDensity(DowsonHigginson):
    law: Literal["twin-density"] = "twin-density"

class TwinShear(Limiting):
    law: Literal["twin-shear"] = "twin-shear"
"""
BROKEN = """
import math
from typing import Literal
from tehl.lubricant import Barus, Limiting, ViscosityModel

TEXT = "not a class"

class Numbers(Barus):
    law: Literal["numbers"] = "numbers"
    def viscosity(self, pressure, temperature):
        return self.eta_0 * math.exp(self.alpha * pressure)

class Negative(Barus):
    law: Literal["negative"] = "negative"
    def viscosity(self, pressure, temperature):
        return self.eta_0 * (1.0 - 1e-9 * pressure) + 0.0 * temperature

class Other(Barus):
    pass

class Lazy(ViscosityModel):
    law: Literal["lazy"] = "lazy"
    reference_temperature: float = 313.15

class Inverse(Limiting):
    law: Literal["inverse"] = "inverse"
    def stress_at(self, rate):
        return 0.5 * super().stress_at(rate)
"""
CASE = """
[contact]
radius = "20 mm"
hertz_pressure = "0.5 GPa"
entrainment_speed = "1 m/s"
slide_roll_ratio = 0.3

[surface_1]
material = "steel"

[surface_2]
material = "steel"

[lubricant]
viscosity = {}
density = {{ law = "dowson-higginson", rho_0 = "870 kg/m^3" }}
conductivity = "0.14 W/m/K"
heat_capacity = "2000 J/kg/K"

[numerics]
points = 65
"""
MCEWEN = '{ law = "mcewen", eta_0 = "0.04 Pa s", alpha = "22 1/GPa", q = 10, gamma = "0.04 1/K" }'
BARUS = '{ law = "barus", eta_0 = "0.04 Pa s", alpha = "22 1/GPa" }'


def install(folder: Path, module: str, text: str, laws: dict[str, str]) -> Path:
    """Install a package of one module into a folder for ``PYTHONPATH``, as pip would."""
    folder.mkdir(exist_ok=True)
    (folder / f"{module}.py").write_text(text, encoding="utf-8")
    info = folder / f"{module}-1.2.dist-info"
    info.mkdir()
    name = module.replace("_", "-")
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.2\n")
    lines = [f"{law} = {place}" for law, place in laws.items()]
    (info / "entry_points.txt").write_text("\n".join(["[tehl.laws]", *lines, ""]))
    return folder


def ran(folder: Path, site: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run Python in a folder, with the packages of ``site``."""
    path = os.pathsep.join(filter(None, (str(site), os.environ.get("PYTHONPATH"))))
    return subprocess.run(
        [sys.executable, *words],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """Return a folder with cases and with the example and the twins installed in ``site``."""
    folder = tmp_path_factory.mktemp("own")
    stated = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    text = (EXAMPLE / "mcewen_law.py").read_text(encoding="utf-8")
    install(folder / "site", "mcewen_law", text, stated["entry-points"]["tehl.laws"])
    twins = {f"twin-{part}": f"twins:Twin{part.title()}" for part in ("viscosity", "density")}
    install(folder / "site", "twins", TWINS, twins | {"twin-shear": "twins:TwinShear"})
    (folder / "case.toml").write_text(CASE.format(MCEWEN))
    (folder / "barus.toml").write_text(CASE.format(BARUS))
    return folder


def test_a_case_states_the_law_of_a_package_and_its_result_names_it(place):
    done = ran(place, place / "site", "-m", "tehl", "solve", "case.toml", "-o", "film.nc")
    assert done.returncode == 0, done.stderr
    script = """
import tehl
result = tehl.load("film.nc")
law = result.problem.lubricant.viscosity
print(type(law).__module__, law.law, law.q, law.alpha, law.temperature_law, sep="|")
print(law.viscosity(5e8, 323.15))
print(law.pressure_coefficient, law.temperature_coefficient)
print(result.central_film_thickness)
"""
    read = ran(place, place / "site", "-c", script)
    assert read.returncode == 0, read.stderr
    words, viscosity, slopes, film = read.stdout.splitlines()
    assert words == "mcewen_law|mcewen|10.0|2.2e-08|mcewen, with temperature"
    # (1 + 22 * 0.5 / 10)^10 = 2.1^10 at 0.5 GPa; exp(-0.4) at 10 K above the reference
    assert float(viscosity) == pytest.approx(0.04 * 2.1**10 * 0.670320046, rel=1e-8)
    assert [float(one) for one in slopes.split()] == pytest.approx([2.2e-8, 0.04], rel=1e-6)
    assert 1e-7 < float(film) < 1e-6


def test_without_the_package_one_sentence_names_it(place, monkeypatch, capsys):
    """It is not installed for the process of the tests either."""
    monkeypatch.chdir(place)
    shutil.copy("film.nc", "sent.nc")
    sentence = (
        'sent.nc has lubricant.viscosity.law = "mcewen" of the package mcewen-law 1.2: install it '
        "to read this file"
    )
    with pytest.raises(FileFormatError) as caught:
        tehl.load("sent.nc")
    assert str(caught.value) == sentence
    monkeypatch.setattr(sys, "argv", ["tehl", "plot", "sent.nc", "-o", "pictures"])
    with pytest.raises(SystemExit) as end:
        cli.main()
    said = capsys.readouterr()
    assert (end.value.code, said.out, said.err) == (2, "", f"tehl: {sentence}\n")
    with pytest.raises(InputError, match=r'viscosity\.law = "mcewen": unknown; known are roelands'):
        tehl.read_case("case.toml")


def test_a_copy_of_a_law_gives_its_bits_without_compiling_anything(place):
    script = """
import gc
import numpy as np
import tehl
from numba.core.dispatcher import Dispatcher

def kernels():
    return sum(len(one.signatures) for one in gc.get_objects() if isinstance(one, Dispatcher))

heated = ["thermal={}", "lubricant.viscosity.gamma=0.04"]
shear = "lubricant.shear={law='limiting', slope=0.05}"
first = tehl.solve(*tehl.read_case_and_options("barus.toml", [*heated, shear]))
before = kernels()
twins = [f"lubricant.{part}.law=twin-{part}" for part in ("viscosity", "density")]
twins += [shear.replace("limiting", "twin-shear")]
second = tehl.solve(*tehl.read_case_and_options("barus.toml", heated + twins))
print([type(getattr(second.problem.lubricant, part)).__name__ for part in ("viscosity", "shear")])
print(kernels() - before, np.array_equal(first.film, second.film))
print(np.array_equal(first.heat.temperature, second.heat.temperature), first.status.converged)
"""
    done = ran(place, place / "site", "-c", script)
    assert done.returncode == 0, done.stderr
    names, kernels, heat = done.stdout.splitlines()
    assert names == "['TwinViscosity', 'TwinShear']"
    assert (kernels, heat) == ("0 True", "True True")


FAULTS = {
    "lubricant.viscosity.law='numbers'": "1.2, which cannot be used: it gives TypeError: only ",
    "lubricant.viscosity.law='negative'": "it has viscosity 0 at 1e+09 Pa and 253.15 K",
    "lubricant.viscosity.law='other'": "which has another name in its class: broken:Other needs",
    "lubricant.viscosity.law='text'": "broken 1.2, which is not a law: broken:TEXT must be a class",
    "lubricant.viscosity.law='gone'": '"gone" of broken 1.2, which cannot be loaded: Attribute',
    "lubricant.viscosity={law='lazy'}": "it gives NotImplementedError",
    "lubricant.viscosity.law='inverse'": "unknown; ",  # a law of shear
    "lubricant.viscosity.law='numbrs'": "unknown; did you mean numbers?",
    "lubricant.viscosity={law='numbers', gama=0.04}": "gama is not a known key; did you mean g",
    "lubricant.shear={law='inverse', stress=2e7}": "it needs a stress_at",
    "lubricant.shear={law='inverse', slop=0.04}": "slop is not a known key; did you mean sl",
}


def test_what_is_wrong_with_a_law_is_one_sentence(place, tmp_path):
    laws = {name: f"broken:{name.title()}" for name in ("numbers", "negative", "other", "lazy")}
    laws |= {"inverse": "broken:Inverse", "text": "broken:TEXT", "gone": "broken:Gone"}
    site = install(tmp_path / "site", "broken", BROKEN, laws | {"barus": "broken:TEXT"})
    script = f"""
import tehl
for fault in {list(FAULTS)}:
    try:
        tehl.read_case_and_options("barus.toml", [fault])
    except tehl.InputError as error:
        print(error)
print(type(tehl.read_case("barus.toml").lubricant.viscosity).__module__)
"""
    done = ran(place, site, "-c", script)
    assert done.returncode == 0, done.stderr
    *found, barus = done.stdout.splitlines()
    for sentence, words in zip(found, FAULTS.values(), strict=True):
        assert words in sentence
    assert barus == "tehl.lubricant.viscosity"  # a package does not replace a law of tehl
