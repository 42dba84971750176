"""A whole diagnosis of files: read them, diagnose, write the tire, build and replay its FMU, write the results.

The command, the batch and the blind trials all call `run_diagnosis`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from radialtire import InputError, ParameterError, TireFileError, TireModel, read_tire

from ..computing.staging import staged
from ..errors import TirelabError
from ..fmu.build import build_fmu
from ..fmu.foreign import ForeignFmu, Simulation, read_foreign, tire_inside
from ..fmu.replay import replay
from ..fmu.system import SYSTEM
from ..names import with_power
from ..planning.rig import read_rig
from ..preprocessing.samples import alone
from ..recordings.files import recording_files
from ..recordings.reading import Reading
from ..recordings.recording import Recording
from ..report.page import write_report
from ..simulation.simulate import simulate
from .diagnose import PoorRecording, diagnose
from .moved_simulation import diagnose_beside
from .outcome import (
    DATA,
    FMU,
    REPORT,
    TEST,
    Replayed,
    command_line,
    content_of,
    files_read,
    sha256,
)
from .request_checks import (
    beyond_fitted,
    check_apart,
    check_depth,
    check_folder,
    check_once,
    pulls_told,
    without_time,
)
from .simulation_correction import CORRECTION, Believed, believed_of, deliver, simulated_by, write_corrected
from .verdict import Verdict
from .written_files import write_samples, write_verdict

AGREEMENT = 1e-9
"""The FMU and the simulation may differ by this part of the largest force: they add in another order."""

MOST_REPLAYED = 200_000
"""Budget: most samples, of fitted and of held-out recordings each, on which the corrected FMU is replayed: some 6 s."""

FloatArray = NDArray[np.float64]
Progress = Callable[[str], None]

Diagnoser = Callable[[Sequence[Path], "Path | None", Path], None]
"""Diagnoses recordings with a baseline tire's file (None: the article's) and writes a folder."""


@dataclass(frozen=True)
class DiagnosisRun:
    """A diagnosis that was written: the verdict, the content of diagnosis.json, notes and warnings.

    notes: of the files that were skipped, and of the recordings as they were read; warnings: for the top of the report
    """

    verdict: Verdict
    content: Mapping[str, Any]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]


def run_diagnosis(
    recordings: Sequence[Path],
    out: Path,
    *,
    tire: Path | Simulation | None = None,
    held_out: Sequence[Path] = (),
    reading: Reading = Reading(),  # noqa: B008
    progress: Progress | None = None,
) -> DiagnosisRun:
    """Diagnose files or folders of recordings and write everything into `out`.

    tire: file of the baseline tire, None for the article's, or the FMU of a simulation; held_out: recordings that are
    not fitted; reading: how the files are read; progress: called with a sentence for each stage

    Raises TirelabError with one sentence where a file cannot be read, diagnosed or written.
    """
    return run_request(Request(tuple(recordings), out, tire, tuple(held_out), reading), progress)


@dataclass(frozen=True)
class Request:
    """What `run_diagnosis` is asked for; samples: whether the data behind the plots is written; rig: file of the limits
    of the rig that would drive the next test.
    """

    recordings: tuple[Path, ...]
    out: Path
    tire: Path | Simulation | None = None
    held_out: tuple[Path, ...] = ()
    reading: Reading = Reading()  # noqa: RUF009
    samples: bool = True
    rig: Path | None = None

    @property
    def simulation(self) -> Path | None:
        """File of the baseline, None for the article's tire."""
        return self.tire.fmu if isinstance(self.tire, Simulation) else self.tire


def run_request(asked: Request, progress: Progress | None = None) -> DiagnosisRun:
    """Diagnose as it is asked; see `run_diagnosis`."""
    report = progress or (lambda sentence: None)
    limits = None if asked.rig is None else read_rig(asked.rig, {}).test_limits
    baseline, model, baseline_notes = _baseline(asked.tire)
    asked = replace(asked, reading=asked.reading.of_part()) if baseline.is_part else asked
    read = _read_all(asked, report, baseline)
    origin = _origin(asked, read.files)
    fitted, kept = read.fitted, read.kept
    believed = _simulation(asked, model, fitted, [alone(r) for r in kept], report)
    if believed is not None:
        fitted, kept = believed.fitted, believed.kept
    try:
        verdict = (
            diagnose(fitted, baseline, held_out=kept, limits=limits, progress=report)
            if believed is None
            else diagnose_beside(believed, limits, report)
        )
    except PoorRecording as error:
        doubts = [f"{r.name}: {doubt}" for r in fitted for doubt in r.doubts]
        raise PoorRecording("; ".join([str(error), *doubts])) from None
    with staged(asked.out) as folder:
        found = _Found(verdict, fitted, kept, believed)
        content, warnings = _delivered(folder, found, origin, report, asked.samples)
    _remove_outdated(asked, found)
    notes = [*baseline_notes, *read.skipped]
    notes += [f"{r.name}: {note}" for r in (*fitted, *kept) for note in r.notes]
    return DiagnosisRun(verdict, content, tuple(notes), tuple(warnings))


@dataclass(frozen=True)
class _Read:
    """The recordings of a request, fitted and held out, all their files, and notes on files that were skipped."""

    fitted: tuple[Recording, ...]
    kept: tuple[Recording, ...]
    files: tuple[Path, ...]
    skipped: tuple[str, ...]


def _read_all(asked: Request, report: Progress, baseline: TireModel) -> _Read:
    """Read the recordings; raises TirelabError for a request that would fail after the work (see `request_checks`)."""
    files, skipped = recording_files(asked.recordings, asked.reading.columns)
    kept_files, more_skipped = recording_files(asked.held_out, asked.reading.columns)
    every = (*files, *kept_files)
    check_once(every)
    check_folder(asked.out)
    fitted = tuple(alone(_read(file, asked.reading, report)) for file in files)
    kept = tuple(_read(file, asked.reading, report) for file in kept_files)
    check_apart(list(zip(every, (*fitted, *kept), strict=True)))
    check_depth(fitted, kept, baseline)
    return _Read(fitted, kept, every, tuple(map(str, (*skipped, *more_skipped))))


def _origin(asked: Request, files: Sequence[Path]) -> dict[str, Any]:
    """Return command, date and files with their hashes, by which the page says how to repeat the diagnosis."""
    beside = [file for file in (asked.simulation, asked.rig) if file is not None]
    return {
        "command": command_line(
            asked.recordings, asked.out, asked.tire, asked.held_out, asked.reading, asked.rig
        ),
        "date": datetime.now().astimezone().isoformat(timespec="seconds"),
        "files": [(str(file), sha256(file)) for file in files_read(files, asked.reading.settings, beside)],
    }


def _remove_outdated(asked: Request, found: _Found) -> None:
    """Remove files of an earlier diagnosis from the folder that this one did not write: they would seem to be its
    own.
    """
    believed = found.believed
    written = {
        TEST: found.verdict.test is not None,
        DATA: asked.samples,
        FMU: believed is None,
        CORRECTION: believed is not None,
        SYSTEM: believed is not None and believed.model is not None,
    }
    for name in (name for name, is_new in written.items() if not is_new):
        (asked.out / name).unlink(missing_ok=True)


@dataclass(frozen=True)
class _Found:
    """A verdict with the recordings that it is of, fitted and held out, and the simulation that stands in them."""

    verdict: Verdict
    fitted: tuple[Recording, ...]
    kept: tuple[Recording, ...]
    believed: Believed | None


def _delivered(
    folder: Path, found: _Found, origin: Mapping[str, Any], report: Progress, samples: bool
) -> tuple[dict[str, Any], list[str]]:
    """Write everything into `folder`; return the content of diagnosis.json and the warnings.

    origin: command, date and files, by which the page says how to repeat it; samples: whether the data behind the plots
    is written
    """
    verdict, fitted, kept, believed = found.verdict, found.fitted, found.kept, found.believed
    report("building the corrected FMU")
    of_correction: dict[str, Any] = {}
    if believed is None:
        fmu = build_fmu(verdict.tire, folder).path
        on_fitted, more = _replayed(fmu, fitted, verdict, report)
        on_kept, warnings = _replayed(fmu, kept, verdict, report)
    else:
        corrected = deliver(folder, believed, verdict.tire, report)
        on_fitted, more = corrected.replayed(fitted, report), corrected.notes()
        on_kept, warnings = corrected.replayed(kept, report), []
        verdict = corrected.told(verdict, on_fitted, on_kept)
        write_corrected(folder, on_fitted)
        write_corrected(folder, on_kept)
        of_correction = {"corrected_fmu": CORRECTION, "correction": corrected.to_dict()}
    warnings += [*without_time((*fitted, *kept)), *beyond_fitted(fitted, kept)]
    warnings += pulls_told((*fitted, *kept), verdict.tire) if believed is None else []
    # The terminal has them among the notes.
    doubts = [f"{r.name}: doubtful: {doubt}" for r in (*fitted, *kept) for doubt in r.doubts]
    report("writing the report")
    content = content_of(verdict.to_dict(), on_fitted, on_kept)
    content |= of_correction
    if samples:
        write_samples(folder, (("fitted", on_fitted), ("held-out", on_kept)))
    else:
        content["data"] = None
    write_verdict(folder, content, verdict)
    write_report(
        folder / REPORT,
        {
            **content,
            **verdict.page_content(),
            **origin,
            "warnings": [*doubts, *more, *warnings],
            "delivered": of_correction.get("correction"),
        },
        fitted,
        on_fitted.before,
        on_fitted.after,
        held_out=(kept, on_kept.before, on_kept.after) if kept else None,
    )
    return content, [*more, *warnings]


def diagnose_files(recordings: Sequence[Path], tire: Path | None, out: Path) -> None:
    """Diagnose files with the baseline of a tire file, None for the article's, into the folder `out`.

    The data behind the plots is not written: hundreds of blind trials would fill a disk with it.
    """
    run_request(Request(tuple(recordings), out, tire, samples=False), None)


def _baseline(
    tire: Path | Simulation | None,
) -> tuple[TireModel, ForeignFmu | None, tuple[str, ...]]:
    """Return the baseline tire, the FMU in whose place it will stand where that is no tire of ours, and notes."""
    try:
        if not isinstance(tire, Simulation):
            return _explained(TireModel() if tire is None else read_tire(tire)), None, ()
    except (TireFileError, ParameterError, InputError) as error:
        raise TirelabError(str(error)) from None
    inside = tire_inside(tire.fmu)
    if inside is None:
        model = read_foreign(tire)
        return TireModel(), model, model.notes
    if tire.variables:
        raise TirelabError(
            f"{tire.fmu} is a tire of tirelab, whose variables are known; leave out --variables"
        )
    return _explained(inside), None, (f"the baseline is the tire inside {tire.fmu.name}: {inside.name}",)


def _explained(tire: TireModel) -> TireModel:
    """Return a tire; raises TirelabError where it has a learned remainder, which would hide what is looked for."""
    if tire.remainder is not None:
        raise TirelabError(
            f"{tire.name} has a learned remainder, which hides what is looked for; diagnose the tire without it"
        )
    return tire


def _simulation(
    asked: Request,
    model: ForeignFmu | None,
    fitted: Sequence[Recording],
    kept: Sequence[Recording],
    report: Progress,
) -> Believed | None:
    """Return the simulation beside which effects are looked for, None where the baseline is a tire."""
    if model is None or not isinstance(asked.tire, Simulation):
        believed = believed_of(fitted, kept)
    elif all(r.believed_force is None for r in (*fitted, *kept)):
        return simulated_by(model, asked.tire.timeout, fitted, kept, report)
    else:
        raise TirelabError("--fmu and --believed-force both name a simulation; give one of them")
    if believed is not None and asked.tire is not None:
        named = "--fmu" if isinstance(asked.tire, Simulation) else "--tire"
        raise TirelabError(f"{named} and --believed-force both name a simulation; give one of them")
    return believed


def _read(file: Path, reading: Reading, progress: Progress) -> Recording:
    progress(f"reading {file.name}")
    return reading(file)


def _replayed(
    fmu: Path, recordings: Sequence[Recording], verdict: Verdict, progress: Progress
) -> tuple[Replayed, list[str]]:
    """Return the forces of the baseline and of the corrected FMU, beyond MOST_REPLAYED of its tire, and warnings."""
    forces, warnings, left = [], [], MOST_REPLAYED
    for recording in recordings:
        force = simulate(verdict.tire, recording)
        if left > 0:
            progress(f"replaying the corrected FMU on {recording.name}")
            replayed = replay(fmu, recording, most=left)
            warnings += _disagreement(recording, replayed, force[: replayed.size])
            force = np.concatenate([replayed, force[replayed.size :]])
            left -= replayed.size
        forces.append(force)
    if (count := sum(force.size for force in forces)) > MOST_REPLAYED:
        names = ", ".join(r.name for r in recordings)
        warnings.append(
            f"the corrected FMU was replayed on the first {MOST_REPLAYED} of {count} samples of {names}, and its tire "
            "simulated on the others; tirelab compare replays it on all of them"
        )
    before = tuple(simulate(verdict.baseline, r) for r in recordings)
    return Replayed(tuple(recordings), before, tuple(forces)), warnings


def _disagreement(recording: Recording, replayed: FloatArray, simulated: FloatArray) -> list[str]:
    """Return a warning where the FMU and the simulation disagree."""
    difference = float(np.max(np.abs(replayed - simulated)))
    if difference <= AGREEMENT * float(np.max(np.abs(simulated))) + 1e-12:
        return []
    by = f"the corrected FMU differs by up to {with_power(f'{difference:.3g}')} N from the fitted simulation"
    return [f"on {recording.name} {by}; the stated errors are those of the FMU"]
