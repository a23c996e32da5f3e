"""What is generated of the program is up to date, and JSON has the fields that it states."""

import pytest
from generate import FILES


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_generated_files_are_up_to_date(path):
    assert path.read_text("utf-8") == FILES[path](), "python tests/generate.py writes it anew"
