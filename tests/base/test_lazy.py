import subprocess
import sys

from tehl.base.lazy import lazy

PROGRAM = """
import sys
from tehl.base.lazy import lazy
lists = lazy("tehl.base.lists")
assert "tehl.base.lists" not in sys.modules
assert lists.heading("load [N]") == ("load", "N")
assert "tehl.base.lists" in sys.modules
"""


def test_a_module_is_loaded_with_its_first_use():
    subprocess.run([sys.executable, "-c", PROGRAM], check=True)


def test_a_change_of_the_module_is_seen(monkeypatch):
    monkeypatch.setattr("tehl.base.lists.heading", len)
    assert lazy("tehl.base.lists").heading("four") == 4
