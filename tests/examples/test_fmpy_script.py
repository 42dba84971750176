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
    # The last row is the moment that the script announces: 2 cm, 550.9 N * 2^1.422.
    assert rows[-1] == ("2.00", f"{550.9 * 2**1.422:.1f}")
    assert "1.0 s: 2.00 cm" in done.stdout.splitlines()[-1]


def test_the_wheel_hops_in_model_exchange(repository: Path, tmp_path: Path) -> None:
    """Contact ends at a quarter of the second and begins at three quarters, where the cosine is 0."""
    done = subprocess.run(
        [sys.executable, repository / "examples" / "modelica" / "model_exchange.py"],
        cwd=tmp_path,
        env={"PYTHONPATH": str(repository / "fmu_src"), "PATH": "", "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    events = [line for line in done.stdout.splitlines() if line.endswith("contact begins or ends")]
    assert {line.split()[0] for line in events} == {"0.2500", "0.7500"}
    assert "0.0000 s:  10.00 mm,  550.9 N" in done.stdout
