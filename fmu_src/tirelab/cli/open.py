"""tirelab open: a small page on this machine, from a dropped recording to a corrected tire."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import TirelabError
from .options import FILE, SentenceCommand, check_files
from .output import example


@click.command("open", cls=SentenceCommand, epilog=example("tirelab open my_tires"))
@click.argument("folder", metavar="[DIR]", type=FILE, default=Path("tirelab_open"))
@click.option("--tire", type=FILE, help="Tire file of the baseline.  [default: the article's tire]")
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Port.  [default: a free one]")
@click.option(
    "--largest", type=click.IntRange(1, 100_000), default=1000, show_default=True, help="Largest file [MB]."
)
@click.option("--no-browser", is_flag=True, help="Only print the address.")
def command(folder: Path, tire: Path | None, port: int, largest: int, no_browser: bool) -> None:
    """Open a page in the browser: drop recordings, correct how they are read, diagnose, take the tire and its FMU.

    Recordings and diagnoses are kept in DIR (by default tirelab_open). The page answers this machine alone, and only at
    the address printed. Ctrl-C ends it.
    """
    from ..local_page.server import Server, Workbench
    from ..local_page.store import Store

    if tire is not None:
        check_files([tire])
    store = Store(folder)
    store.prepare()
    workbench = Workbench(store, tire, largest * 1_000_000)
    try:
        server = Server(workbench, port)
    except OSError as error:
        raise TirelabError(
            f"port {port} cannot be opened ({error.strerror}); name another with --port"
        ) from None
    click.echo(f"{server.address}\nrecordings and results are kept in {folder}; Ctrl-C ends")
    if not no_browser:
        import webbrowser

        webbrowser.open(server.address)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        click.echo("ended", err=True)
    finally:
        server.server_close()
        workbench.close()
