"""Every example of the guides is executed."""
import importlib.util
import re

import pytest
from conftest import ROOT

PAGES = ["python", "coming-from"]


@pytest.mark.parametrize("page", PAGES)
def test_the_examples_of_a_page_run(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "docs" / f"{page}.md").read_text()
    blocks = re.findall(r"```python ?(\w*)\n(.*?)```", text, re.S)
    assert len(blocks) >= 4
    names = {}
    exec("import numpy as np\nimport freiform as ff", names)
    for needs, block in blocks:
        if needs and importlib.util.find_spec(needs) is None:
            continue
        exec(compile(block, f"docs/{page}.md", "exec"), names)


def test_every_name_that_the_pages_mention_exists():
    import freiform as ff
    for page in PAGES:
        for name in re.findall(r"\bff\.(\w+)", (ROOT / "docs" / f"{page}.md").read_text()):
            assert hasattr(ff, name), name
