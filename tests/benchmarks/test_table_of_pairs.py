"""The table of pairs of physics: it prints each outcome, and goes on where it was ended."""

from benchmarks.pairs import Task, main, stored


def test_the_table_of_pairs_goes_on_where_it_was_ended(monkeypatch, tmp_path, capsys):
    file = tmp_path / "pairs.jsonl"
    command = ["pairs", "--points", "65", "--only", "line", "--store", str(file)]
    monkeypatch.setattr("sys.argv", command)
    monkeypatch.setattr("benchmarks.pairs.WAYS", {"solve": lambda *_: None})
    main()
    lines = file.read_text().splitlines()
    assert Task(features=("heat", "line"), points=65) in [one.task for one in stored(file)]
    file.write_text("\n".join([*lines[:-1], lines[-1][:20]]))  # ended while it wrote
    capsys.readouterr()
    main()
    again, _, table = capsys.readouterr().out.partition("Physics that work together")
    assert len(again.splitlines()) == 1
    assert table.count("works") == 2 * (len(lines) - 1) + 1
