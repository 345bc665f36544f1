"""Prose is that of the field: no private dialect in messages, docstrings, comments and pages."""

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from functools import cache
from itertools import chain, pairwise
from pathlib import Path

import pytest

from tests import house

ROOT = Path(__file__).parents[1]
FOLDERS = ("src", "docs", "examples", "benchmarks", "paper")
PROSE = (".md", ".html", ".txt", ".toml", ".js")

DIALECT = {
    r"told|telling|untold": "reported, printed, shown",
    r"nobody": "the passive, or the component",
    r"(?<!there )(is|are|was|were|be|been) no (?!longer|more than|less than)": "is not a",
    r"(is|are|has|have|holds?) no numbers?": "is NaN; is not a number",
    r"(goes|go|going|went) to and fro|to and fro": "oscillates",
    r"meniscus rests|rests of the meniscus": "the meniscus is fixed",
    r"(made or lost|gets lost|got lost)": "mass-balance error",
    r"in each other's way|in one another's way": "conflict",
    r"beyond all|out of all measure": "far outside the physical range",
    r"learnt|learns": "computed, read; extra summary blocks",
    r"believed?|believes|believing": "accept",
    r"let go|lets go|letting go": "release",
    r"h[eo]ld back|holds back|holding back": "limit",
    r"gentle|gently|gentler": "small slope; damped",
    r"askew": "oblique",
    r"in disorder": "not converging",
    r"so many|as many as|so much(?! as)": "the count, with its unit",
    r"as large as .* itself|times itself": "relative error",
    r"no answers?|without an answer": "failed case",
    r"(a|the) run in time|runs in time|instants? of a run": "transient run; snapshot",
    r"twins?": "reference run",
    r"knows? no|know nothing|knows nothing|not know": "does not use; not available",
    r"wish(es|ed)?": "request",
    r"refuses? an answer|refuses to answer": "reports an error",
    r"step by step to the end": "time integration",
    r"once more": "again",
    r"the dying|dying|dead": "crash",
    r"would take (it|them) for": "aliased",
}
"""What is not written, as regular expressions of whole words, and what is written instead."""

NO_PROSE = {
    "title name contact position id no number nr": "headings of a column that are recognised",
}
"""Strings that hold a word of the dialect as data."""

VAGUE = """
ABOVE AGAIN APART AROUND BELOW BESIDE BEYOND BIG CLOSE COARSE DEEPEST ENOUGH EVERY FAR FARTHEST
FEW FEWEST FINE FINER FINEST FIRST HIGH HIGHER HIGHEST HOT HOTTEST KEPT KNOWN LARGE LARGER
LARGEST LAST LATE LATER LEAST LEFT LITTLE LONGER LONGEST LOST LOW LOWEST MANY MARGIN MIDDLE
MISSED MORE MOST MOSTLY NEAR NEARER NEGLIGIBLE NOTHING OPEN OTHERS PART PARTS PLENTY QUICK
RAISED REACH RESOLVED ROOM ROUNDING SEVERE SHORT SHORTEST SHOWN SLOW SLOWER SLUGGISH SMALL
SMALLER SMALLEST STEP STEPS THICK THICKEST THIN THINNEST TIGHTER TIMES TINY TOLERANCE WHOLE WIDE
WIDER WIDEST WORSE
"""
"""Names of constants that do not name a quantity."""

NO_NAMES = (
    "askew",
    "believed",
    "gentle",
    "learnt",
    "nobody",
    "telling",
    "told",
    "twin",
    "twins",
)
"""Parts of names that are of the dialect."""

FILLERS = frozenset(("case", "contact", "grid", "nodes", "result", "run"))
"""What a type says already, so that a section need not."""

PATTERN = re.compile("|".join(rf"\b(?:{words})\b" for words in DIALECT), re.IGNORECASE)


def files(*suffixes: str) -> list[Path]:
    found = chain.from_iterable((ROOT / folder).rglob("*") for folder in FOLDERS)
    kept = (path for path in found if path.suffix in suffixes and "build" not in path.parts)
    return sorted({*kept, *(path for path in ROOT.glob("*.md") if ".md" in suffixes)})


def texts(path: Path) -> Iterator[tuple[int, str]]:
    """Yield the prose of a file with its lines: all of a page, strings and comments of a module."""
    source = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        yield from enumerate(source.splitlines(), 1)
        return
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def findings(text: str) -> list[str]:
    """Return the words of the dialect in a text; a phrase may go on in the next line."""
    return [] if text in NO_PROSE else [m[0] for m in PATTERN.finditer(re.sub(r"\s+", " ", text))]


@pytest.mark.parametrize("folder", [*FOLDERS, "."])
def test_no_file_speaks_dialect(folder):
    found = [
        f"{path.relative_to(ROOT)}:{line}: {word}"
        for path in files(".py", *PROSE)
        if path.relative_to(ROOT).parts[0] == folder or (folder == "." and path.parent == ROOT)
        for line, text in texts(path)
        for word in findings(text)
    ]
    assert found == [], "\n".join(found)


def test_no_name_speaks_dialect():
    found = [
        (str(path.relative_to(ROOT)), token.start[0], token.string)
        for path in files(".py")
        if any(word in (text := path.read_text("utf-8")).lower() for word in NO_NAMES)
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type == tokenize.NAME and set(token.string.lower().split("_")) & set(NO_NAMES)
    ]
    assert found == []


def test_dialect_is_found():
    assert findings("the film\n    goes to and fro") == ["goes to and fro"]
    assert findings("there is no film") == findings("is no longer held") == []
    assert findings("the height is no number") == ["is no "]


def test_constants_of_one_name_have_one_value():
    values = {}
    for module, tree in house.trees().items():
        for name, value in house.numeric_values(tree):
            values.setdefault(name, {}).setdefault(value, []).append(module)
    assert {name: found for name, found in values.items() if len(found) > 1} == {}


def test_constants_name_a_quantity():
    vague = [
        (module, name)
        for module, tree in house.trees().items()
        for name, _ in house.numeric_values(tree)
        if name.strip("_") in VAGUE.split()
    ]
    assert vague == []


@cache
def sections():
    """Return each function that has a section of parameters, with the lines of that section."""
    listed = []
    for module, tree in house.trees().items():
        for node in ast.walk(tree):
            text = ast.get_docstring(node) or "" if isinstance(node, house.FUNCTIONS) else ""
            found = re.search(r"^Parameters\n-+\n(.*?)(?=\n\n\w+\n---|\Z)", text, re.S | re.M)
            if found:
                listed.append((f"{module}.{node.name}", node.args, found[1].splitlines()))
    return listed


def names_of(lines):
    heads = [line.partition(" : ")[0] for line in lines if line and not line.startswith(" ")]
    return [name.strip().lstrip("*") for head in heads for name in head.split(",")]


def test_sections_name_all_parameters():
    wrong = {}
    for name, args, lines in sections():
        given = [*args.posonlyargs, *args.args, *args.kwonlyargs, args.vararg, args.kwarg]
        needed = {one.arg for one in given if one is not None} - {"self", "cls"}
        if set(names_of(lines)) != needed:
            wrong[name] = needed.symmetric_difference(names_of(lines))
    assert wrong == {}


def test_sections_say_more_than_the_name():
    empty = []
    for function, _, lines in sections():
        for head, text in pairwise(lines):
            name, said = head.partition(" : ")[0], text.strip().lower().rstrip(".")
            words = {name.lower(), name.lower().replace("_", " "), *FILLERS}
            if text.startswith(" ") and said.removeprefix("the ").removeprefix("a ") in words:
                empty.append(f"{function}: {name}")
    assert empty == []
