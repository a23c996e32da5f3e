"""What tests share."""

import subprocess
import sys

import pytest


def command_line(*arguments, cwd=None):
    """What the command line of the same wheel prints."""
    words = [sys.executable, "-m", "slipfit", *map(str, arguments)]
    done = subprocess.run(words, capture_output=True, encoding="utf-8", cwd=cwd)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path
