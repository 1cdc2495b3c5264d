"""Tests of the Python package: run with PYTHONPATH at a built package (build*/python)."""
import os
import pathlib

import hypothesis
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
hypothesis.settings.register_profile("quick", max_examples=25, deadline=None, derandomize=True)
hypothesis.settings.register_profile("long", max_examples=1000, deadline=None)
hypothesis.settings.load_profile(os.environ.get("FREIFORM_HYPOTHESIS", "quick"))


def corpus(name):
    """A file of the corpus of other libraries' test cases; skipped where it is not there."""
    path = pathlib.Path(os.environ.get("FREIFORM_CORPUS", ROOT.parent / "shared" / "data")) / name
    if not path.exists():
        pytest.skip(f"{path} is not there (FREIFORM_CORPUS says where the corpus is)")
    return path
