"""The changelog can be read in two minutes."""

from pathlib import Path

TEXT = (Path(__file__).parents[1] / "CHANGELOG.md").read_text(encoding="utf-8")
MOST_WORDS, LONGEST = 900, 130


def test_the_unreleased_part_is_short():
    unreleased = TEXT.split("## [Unreleased]")[1].split("\n## [")[0]
    assert len(unreleased.split()) <= MOST_WORDS
    assert max(map(len, unreleased.splitlines())) <= LONGEST
    headings = [line for line in unreleased.splitlines() if line.startswith("### ")]
    assert headings == ["### Added", "### Changed", "### Fixed", "### Dependencies"]
