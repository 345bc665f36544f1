"""A case on the page names files that were uploaded, or those of the case opened by the user."""

import pytest

from tehl.base.errors import InputError
from tehl.explore.files import LARGEST_UPLOAD, Files, named_files


def case_with(name):
    return {"surface_2": {"roughness": [{"type": "map", "file": name}]}}


@pytest.fixture
def files(tmp_path):
    beside = tmp_path / "cases"
    beside.mkdir()
    (beside / "honed.csv").write_text("1,2\n")
    (tmp_path / "secret.csv").write_text("3,4\n")
    return Files(tmp_path / "uploads", beside, frozenset({"../secret.csv"}))


def test_an_upload_is_found_by_its_plain_name(files):
    assert files.keep("C:\\data\\../my map.csv", b"1,2") == "my_map.csv"
    assert files.keep("my map.csv", b"1,2") == "my_map.csv"
    assert files.keep("my map.csv", b"3,4") == "2-my_map.csv"
    found = files.resolved(case_with("my_map.csv"))
    assert found == case_with(str(files.uploads / "my_map.csv"))


def test_files_beside_the_opened_case_and_those_that_it_states_are_found(files):
    assert files.resolved(case_with("honed.csv")) == case_with(str(files.beside / "honed.csv"))
    assert files.resolved(case_with("../secret.csv")) != case_with("../secret.csv")


@pytest.mark.parametrize(
    "name",
    ["/etc/passwd", "../other.csv", "~/x.csv", "sub/x.csv", "..", "C:\\x.csv", "missing.csv"],
)
def test_other_paths_of_the_machine_are_refused(files, name):
    with pytest.raises(InputError, match=r"surface_2\.roughness\.0\.file = .*expected an uploaded"):
        files.resolved(case_with(name))


def test_a_profile_of_oil_is_a_file_too():
    assert list(named_files({"supply": {"profile": "/etc/hosts"}})) == [
        (("supply", "profile"), "/etc/hosts")
    ]
    assert not list(named_files({"supply": {"profile": [["0 mm", "1 um"]]}}))


def test_uploads_have_a_limit_and_a_known_ending(files):
    with pytest.raises(InputError, match="larger than 50 MB"):
        files.keep("a.csv", b"0" * (LARGEST_UPLOAD + 1))
    with pytest.raises(InputError, match="not a format of heights"):
        files.keep("a.exe", b"0")


def test_messages_do_not_show_folders_of_the_machine(files):
    message = f"map {files.uploads}/a.csv is constant"
    assert files.hidden(message) == "map a.csv is constant"
