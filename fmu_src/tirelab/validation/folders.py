"""Files of a proof: recordings, baseline tires, answers, verdicts, scores.

DIR/settings.json            the seed
DIR/seals.sha256             commitment hash (SHA-256) of every answer, as `sha256sum -c` reads it
DIR/trials/NNNN/             the recordings alone
DIR/tires/NNNN.json          the baseline tire, a tire file
DIR/sealed/NNNN.json         the answer; NNNN.derived.json the right sets by the rig's own fits
DIR/verdicts/NNNN/           what the diagnosis wrote; outcomes/NNNN.json how it ended
DIR/tests/NNNN/test.csv      the recommended test, as the rig recorded it
DIR/second_verdicts/NNNN/    the diagnosis with that recording; second_outcomes/NNNN.json how it ended
DIR/scores/NNNN.json         the score
DIR/proof.json, .html, .png  the proof
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import TirelabError


@dataclass(frozen=True)
class Folders:
    """The folders of a proof under `root`."""

    root: Path

    def trial(self, key: str) -> Path:
        """The recordings of a trial."""
        return self.root / "trials" / key

    def recordings(self, key: str, group: str) -> list[Path]:
        """The recordings of the group "train" or "heldout" of a trial."""
        return sorted(self.trial(key).glob(f"{group}_*.csv"), key=lambda p: int(p.stem.rpartition("_")[2]))

    def tire(self, key: str) -> Path:
        """The baseline tire."""
        return self.root / "tires" / f"{key}.json"

    def sealed(self, key: str) -> Path:
        """The answer."""
        return self.root / "sealed" / f"{key}.json"

    def verdict(self, key: str, *, second: bool = False) -> Path:
        """What the diagnosis wrote; second: the diagnosis with the recommended test."""
        return self.root / ("second_verdicts" if second else "verdicts") / key

    def outcome(self, key: str, *, second: bool = False) -> Path:
        """How the diagnosis ended."""
        return self.root / ("second_outcomes" if second else "outcomes") / f"{key}.json"

    def test(self, key: str) -> Path:
        """The recording of the recommended test."""
        return self.root / "tests" / key / "test.csv"

    def score(self, key: str) -> Path:
        """The score of a trial."""
        return self.root / "scores" / f"{key}.json"

    @property
    def commitments(self) -> Path:
        """The commitment hash of every answer."""
        return self.root / "seals.sha256"


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write a JSON file whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f"{path.name}.partial")
    partial.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    partial.replace(path)


def read_json(path: Path) -> dict[str, Any]:
    """Return the content of a JSON file that this program wrote; raises TirelabError where it is damaged."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise TirelabError(
            f"{path}: cannot be read ({error}); remove the file, and it is written again"
        ) from None
    if not isinstance(content, dict):
        raise TirelabError(f"{path} is no object; remove the file, and it is written again")
    return content
