"""The code on the pages works: the quick start of the book and that of the package."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PAGES = {"book": "cc67/book/src/python.md", "package": "cc67/python/README.md"}


def block(page: str, info: str) -> str:
    """Return the first fenced block of a page that has this info string."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.search(rf"^```{re.escape(info)}$(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert found, f"{page} has no block {info}"
    return found.group(1)


@pytest.mark.parametrize("page", PAGES)
def test_the_quick_start_does_what_it_says(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("square.c").write_text(block("README.md", "c file=square.c"))
    code = block(PAGES[page], "python quick-start" if page == "book" else "python")
    exec(compile(code, PAGES[page], "exec"), {})
    if page == "package":
        assert "at 2000 after 2.30 s" in capsys.readouterr().out


def test_every_call_of_the_book_exists() -> None:
    import cc67.studies

    text = (ROOT / PAGES["book"]).read_text(encoding="utf-8")
    for name in re.findall(r"\bcc67\.([A-Za-z_]\w*)", text):
        if name not in ("toml",):
            assert hasattr(cc67, name), name
    for name in re.findall(r"\bb\.([a-z_]+)", text):
        assert hasattr(cc67.Board, name), name
