"""tirelab article: the article's claims and figures computed again."""

from __future__ import annotations

import click

from .options import SentenceCommand
from .output import Output, example, output_options

WIDTH = 120
"""Columns of the table where the output is no terminal."""


@click.command("article", cls=SentenceCommand, epilog=example("tirelab article --out article"))
@output_options("article")
def command(output: Output) -> None:
    """Compute what Hull, Wang & Moore (1996) claim, say what is reproduced, and redraw figures 1 to 3.

    Writes article.csv, article.json and figure1.png to figure3.png.
    """
    from rich.console import Console

    from ..article.figures import draw
    from ..article.outcomes import check_article, summary, to_csv, to_json, to_table
    from ..computing.staging import staged

    output.stage("computing the article's claims")
    outcomes = check_article()
    with staged(output.out) as folder:
        (folder / "article.csv").write_text(to_csv(outcomes), encoding="utf-8")
        (folder / "article.json").write_text(to_json(outcomes), encoding="utf-8")
        output.stage("drawing the article's figures")
        names = ["article.csv", "article.json", *(path.name for path in draw(folder))]
    if output.as_json:
        output.result((), to_json(outcomes))
        return
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = WIDTH
    console.print(to_table(outcomes))
    console.print(summary(outcomes), soft_wrap=True)
    written = ", ".join(str(output.out / name) for name in names)
    console.print(f"written: {written}", soft_wrap=True, markup=False)
