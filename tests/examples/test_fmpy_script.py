"""The ten-line script, from an empty folder."""

import re
import subprocess
import sys
from pathlib import Path


def test_it_builds_the_fmu_and_prints_the_articles_forces(repository: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, repository / "examples" / "fmpy_script.py"],
        cwd=tmp_path,
        env={"PYTHONPATH": str(repository / "fmu_src"), "PATH": "", "CC": "", "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "dist" / "BicycleTire.fmu").is_file()
    rows = re.findall(r"^[\d.]+ s: ([\d.]+) cm, ([\d.]+) N$", done.stdout, flags=re.MULTILINE)
    assert len(rows) > 5
    for deflection, force in rows:
        # F = 550.9 x^1.422; the deflection is printed to 0.05 mm, a force of up to 1500 N then to 6 N.
        assert abs(float(force) - 550.9 * float(deflection) ** 1.422) < 6.0
    assert max(float(force) for _, force in rows) > 1000.0
