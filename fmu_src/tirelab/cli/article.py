"""tirelab article: the article's claims and figures computed again."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import TirelabError
from .options import SentenceCommand, out_option

WIDTH = 120
"""Columns of the table where the output is no terminal."""


@click.command("article", cls=SentenceCommand)
@out_option("article")
def command(out: Path) -> None:
    """Compute what Hull, Wang & Moore (1996) claim, say what is reproduced, and redraw figures 1 to 3.

    Writes article.csv, article.json and figure1.png to figure3.png.
    """
    from rich.console import Console

    from ..article.figures import draw
    from ..article.outcomes import check_article, summary, to_csv, to_json, to_table

    outcomes = check_article()
    try:
        out.mkdir(parents=True, exist_ok=True)
        written = [out / "article.csv", out / "article.json"]
        written[0].write_text(to_csv(outcomes), encoding="utf-8")
        written[1].write_text(to_json(outcomes), encoding="utf-8")
        written += draw(out)
    except OSError as error:
        raise TirelabError(
            f"{out} cannot be written ({error.strerror}); name another folder with --out"
        ) from None
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDTH
    console.print(to_table(outcomes))
    console.print(summary(outcomes), soft_wrap=True)
    console.print("written: " + ", ".join(str(path) for path in written), soft_wrap=True, markup=False)
