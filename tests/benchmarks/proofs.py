"""The trials of a finished proof that a benchmark diagnoses anew."""

from __future__ import annotations

import argparse
from pathlib import Path


def asked_for(about: str) -> tuple[Path, int, list[str]]:
    """Return what the command line asks for: the folder of the proof, the number of processes, and its trials."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proof", type=Path)
    parser.add_argument("--jobs", type=int, default=2)
    asked = parser.parse_args()
    return asked.proof, asked.jobs, sorted(path.stem for path in (asked.proof / "scores").glob("*.json"))
