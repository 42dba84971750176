"""The residual is located where it is dense, wherever that is; noise is not located at all."""

import json
from dataclasses import replace

import numpy as np
import pytest
from drives import Drive, flat_force, read, ride
from radialtire import CATALOGUE, PowerLaw, Recalibrated, TireModel
from scipy.signal import lfilter
from tirelab.diagnosis.localization import law_corrected, localize
from tirelab.preprocessing.samples import raw_dataset_of
from tirelab.simulation.simulate import simulate

LEVEL = 5.0
"""Noise [N] of every recording here."""


def places(drives, residuals, noises):
    """Return the places of residuals of which a correction that explains everything leaves the noises."""
    dataset = raw_dataset_of(drives, TireModel())
    return localize(drives, dataset, residuals, [np.full(r.size, LEVEL) for r in residuals], noises)


def noise(seed, samples, colour=0.0):
    """White noise, or AR(1) noise of that colour, of `LEVEL`."""
    white = np.random.default_rng(seed).standard_normal(samples)
    return LEVEL * lfilter([np.sqrt(1.0 - colour**2)], [1.0, -colour], white)


def located(added, seed=5, colour=0.0):
    """Return the places of a ride with `added`(time, deflection, rate) left out."""
    time, deflection, rate = ride(3)
    drive = read("ride", time, deflection, flat_force(deflection), 4, noise=0.0)
    own = noise(seed, time.size, colour)
    return places([drive], [own + added(time, deflection, rate)], [own])


def first(spans, by):
    return next(s for s in spans if s.by == by)


def overlap(span, start, stop):
    """Jaccard index of a span and the true one."""
    both = max(0.0, min(span.stop, stop) - max(span.start, start))
    return both / (max(span.stop, stop) - min(span.start, start))


def test_a_force_while_unloading_is_found_by_direction_with_its_share():
    spans = located(lambda t, x, v: np.where(v < 0.0, 12.0, 0.0))
    side = first(spans, "direction")
    assert (side.start, side.stop, side.label) == (-1.0, -1.0, "unloading")
    # 12 N on all of the unloading; small reversals inside it are not counted as loading.
    assert abs(side.mean_residual - 12.0) < 1.0
    assert side.share > 0.9
    assert {s.by for s in spans[:2]} == {"direction", "rate"}
    assert abs(first(spans, "rate").stop) < 1e-3


def test_a_knee_is_found_at_large_deflections():
    spans = located(lambda t, x, v: 1e5 * np.maximum(x - 0.016, 0.0))
    assert spans[0].by == "deflection"
    # Right behind the knee the force is still within the noise: 5 N after 0.05 mm.
    assert 0.016 < spans[0].start < 0.017
    assert spans[0].share > 0.95
    assert spans[0].mean_residual > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(("colour", "recordings"), [(0.0, 40), (0.6, 40), (0.95, 100)])
def test_noise_alone_is_not_located(colour, recordings):
    # Counted sample by sample, AR(1) noise of 0.95 would make dozens of places. Promised: 1 in 1000 recordings.
    found = [s for s in range(recordings) if located(lambda t, x, v: 0.0 * t, seed=s, colour=colour)]
    assert len(found) <= 1


@pytest.mark.parametrize("part", [0.01, 0.02, 0.05])
def test_a_short_span_of_time_is_found_where_it_is(part):
    rng = np.random.default_rng(1)
    for seed in range(8):
        start = rng.uniform(1.0, 27.0)
        stop = start + 30.0 * part
        spans = located(lambda t, x, v, a=start, b=stop: np.where((t >= a) & (t < b), 20.0, 0.0), seed=seed)
        assert overlap(first(spans, "time"), start, stop) > 0.7
        assert "time" in {s.by for s in spans[:2]}


@pytest.mark.parametrize("part", [0.01, 0.02, 0.05])
def test_a_narrow_band_of_deflection_is_found_where_it_is(part):
    rng = np.random.default_rng(2)
    depth = np.sort(ride(3)[1])
    found = []
    for seed in range(8):
        at = int(rng.uniform(0.05, 0.9) * depth.size)
        low, high = depth[at], depth[at + int(part * depth.size)]
        spans = located(lambda t, x, v, a=low, b=high: np.where((x >= a) & (x < b), 20.0, 0.0), seed=seed)
        found.append(overlap(first(spans, "deflection"), low, high))
    # The reading of the deflection has 5 um of noise, a band of 1 % is some 100 um wide: its edges are blurred.
    assert np.median(found) > 0.75
    assert min(found) > (0.5 if part == 0.01 else 0.75)


def test_a_faint_force_that_lasts_is_found_by_its_mean():
    # 0.6 noises over 5 % of the samples: a fiftieth of the noise's squares, but 300 samples of one sign.
    spans = located(lambda t, x, v: np.where((t >= 12.0) & (t < 13.5), 3.0, 0.0))
    assert overlap(first(spans, "time"), 12.0, 13.5) > 0.7


def test_a_loop_is_found_on_both_sides():
    spans = located(lambda t, x, v: 25.0 * np.sign(v))
    sides = {s.label: s for s in spans if s.by == "direction"}
    # Its square is the same everywhere; its mean is not.
    assert sides["loading"].mean_residual == pytest.approx(25.0, abs=3.0)
    assert sides["unloading"].mean_residual == pytest.approx(-25.0, abs=3.0)
    assert {s.by for s in spans} == {"direction", "rate"}


def test_a_ripple_is_found_wave_by_wave():
    spans = located(lambda t, x, v: 25.0 * np.sin(2.0 * np.pi * x / 0.0035))
    waves = [s for s in spans if s.by == "deflection"]
    assert len(waves) >= 3
    for wave in waves:
        # Half a wave is 1.75 mm, and its mean 2 / pi of its height; its foot is left out.
        assert 1.1e-3 < wave.stop - wave.start < 1.75e-3
        assert 16.0 < abs(wave.mean_residual) < 23.0


def test_an_offset_is_everywhere():
    assert located(lambda t, x, v: 20.0 + 0.0 * t) == ()


def test_a_jump_is_found_from_where_it_jumps():
    spans = located(lambda t, x, v: np.where(t >= 17.0, 8.0, 0.0))
    assert spans[0].by == "time"
    assert spans[0].start == pytest.approx(17.0, abs=0.1)
    assert spans[0].stop == pytest.approx(30.0, abs=0.1)


def test_what_each_cycle_repeats_is_no_place_in_time():
    spans = located(lambda t, x, v: np.where(x > 0.012, 15.0, 0.0))
    assert spans[0].by in ("deflection", "force")
    assert not {"time", "cycle"} & {s.by for s in spans}


def two_recordings(forces, radii=(np.inf, np.inf), start=100.0):
    """Return the places of two rides on surfaces `radii` [m] with `forces`(time, deflection) left out."""
    drives, residuals, noises = [], [], []
    for number, (force, radius) in enumerate(zip(forces, radii, strict=True)):
        time, deflection, _ = ride(3 + number)
        surface = np.broadcast_to(radius, time.shape)
        bare = Drive(f"press {number + 1}", time + start, deflection, surface, np.zeros(time.size))
        drives.append(bare)
        noises.append(noise(number, time.size))
        residuals.append(noises[-1] + force(time, deflection))
    drives = [Drive(d.name, d.time, d.deflection, d.surface_radius, simulate(TireModel(), d)) for d in drives]
    return places(drives, residuals, noises)


def nothing(time, deflection):
    return 0.0 * time


def test_a_time_is_told_of_its_recording_and_by_its_own_clock():
    spans = two_recordings([nothing, lambda t, x: np.where((t > 5.0) & (t < 6.0), 20.0, 0.0)])
    time = first(spans, "time")
    assert time.recording == "press 2"
    assert overlap(time, 105.0, 106.0) > 0.8
    assert time.to_dict()["recording"] == "press 2"


def test_recordings_are_numbered_from_one():
    entry = first(two_recordings([nothing, lambda t, x: 10.0 + 0.0 * t]), "recording").to_dict()
    assert (entry["from"], entry["to"], entry["unit"], entry["label"]) == (2.0, 2.0, "1", "press 2")
    assert entry["share"] > 0.95
    assert entry["samples"] == pytest.approx(0.5, abs=0.02)


def test_a_surface_is_told_by_its_radius():
    entry = first(two_recordings([nothing, lambda t, x: 10.0 + 0.0 * t], (np.inf, -0.381)), "radius")
    contract = entry.to_dict()
    assert (contract["from"], contract["to"], contract["unit"]) == (-0.381, -0.381, "m")
    assert contract["label"] == "concave, radius 0.381 m"
    flat = first(two_recordings([lambda t, x: 10.0 + 0.0 * t, nothing], (np.inf, -0.381)), "radius")
    contract = json.loads(json.dumps(flat.to_dict(), allow_nan=False))
    assert (contract["from"], contract["to"], contract["label"]) == ("inf", "inf", "flat")


def test_of_many_surfaces_the_bounds_hold_the_radii_between_them():
    time = ride(3)[0]
    bend = 8.0 * np.sin(2.0 * np.pi * time / 7.3)
    with np.errstate(divide="ignore"):
        radius = 1.0 / bend
    sharp = np.where((bend > 3.0) & (bend < 6.0), 20.0, 0.0)
    span = first(two_recordings([nothing, lambda t, x: sharp], (radius, radius)), "radius")
    assert span.start == pytest.approx(1.0 / 6.0, rel=0.03)
    assert span.stop == pytest.approx(1.0 / 3.0, rel=0.03)
    hollow = np.where(bend < -3.0, 20.0, 0.0)
    span = first(two_recordings([nothing, lambda t, x: hollow], (radius, radius)), "radius")
    assert span.start == pytest.approx(-1.0 / 3.0, rel=0.03)
    assert span.stop == pytest.approx(-1.0 / 8.0, rel=0.03)
    level = np.where(np.abs(bend) < 0.5, 20.0, 0.0)
    spans = [s for s in two_recordings([nothing, lambda t, x: level], (radius, radius)) if s.by == "radius"]
    # Flatter than the reach of the law's curves is flat; on either side of it the radii are at least 2 m.
    assert {np.sign(s.start) if np.isfinite(s.stop) else s.label for s in spans} == {-1.0, 1.0, "flat"}
    assert all(min(abs(s.start), abs(s.stop)) > 1.7 for s in spans)


def test_cycles_are_numbered_from_one():
    time = np.arange(6000) * 0.005
    deflection = 0.01 * (1.0 - np.cos(2.0 * np.pi * time / 3.0))
    drive = read("cycles", time, deflection, flat_force(deflection), 4, noise=0.0)
    own = noise(1, time.size)
    softening = np.where(time < 3.0, 30.0 * deflection / 0.02, 0.0)
    entry = first(places([drive], [own + softening], [own]), "cycle").to_dict()
    assert (entry["from"], entry["to"], entry["label"]) == (1.0, 1.0, "cycle 1")
    second = np.where((time >= 9.0) & (time < 18.0), 30.0 * deflection / 0.02, 0.0)
    entry = first(places([drive], [own + second], [own]), "cycle").to_dict()
    assert (entry["from"], entry["to"], entry["label"]) == (4.0, 6.0, "cycles 4 to 6")


def test_a_force_is_told_as_it_was_recorded():
    time, deflection, _ = ride(3)
    own = noise(1, time.size)
    capped = np.minimum(flat_force(deflection), 1000.0) + own
    drive = read("capped", time, deflection, capped, 4, noise=0.0)
    force = first(places([drive], [capped - flat_force(deflection)], [own]), "force")
    # The believed tire goes on to 1600 N there; the recording stays at its ceiling, give or take four noises.
    assert 980.0 < force.start < 1000.0 < force.stop < 1020.0


def test_places_are_those_of_the_physics_where_the_law_is_wrong_too():
    time, deflection, rate = ride(3)
    believed, law = TireModel(), Recalibrated(surfaces=((np.inf, 0.1, 0.0),))
    damped = ((CATALOGUE["viscous_damping"], (500.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0)),)
    corrected = TireModel(law=law, effects=damped)
    recorded = np.exp(0.1) * flat_force(deflection) + 500.0 * rate
    drive = read("ride", time, deflection, recorded, 4, noise=0.0)
    before = [recorded - flat_force(deflection)]
    # exp(0.1) on A is not 500 N.s/m: what the law leaves is the dashpot's force alone.
    both = ("recalibration", "viscous_damping")
    (left,) = law_corrected([drive], before, believed, corrected, both)
    assert np.max(np.abs(left - 500.0 * rate)) < 10.0
    assert law_corrected([drive], before, believed, TireModel(law=law), both[:1])[0] is before[0]
    assert law_corrected([drive], before, believed, TireModel(effects=damped), both[1:])[0] is before[0]


def test_the_shape_of_a_refitted_law_belongs_to_the_law() -> None:
    """A part's law is corrected by another shape beside its factor: what is left is the dashpot's force alone."""
    time, deflection, rate = ride(3)
    believed = TireModel(PowerLaw(1e3, 1.0), tested_range=None, two_sided=True, inflated=False)
    shape = CATALOGUE["elastic_shape"]
    bent = (shape, (0.3, 0.0, 0.01, *[0.0] * (len(shape.parameters) - 3)))
    damped = (CATALOGUE["viscous_damping"], (500.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    recorded = (
        simulate(replace(believed, effects=(bent,)), read("x", time, deflection, rate, 4)) + 500.0 * rate
    )
    drive = read("ride", time, deflection, recorded, 4, noise=0.0)
    before = [recorded - simulate(believed, drive)]
    corrected = replace(believed, effects=(bent, damped))
    (left,) = law_corrected([drive], before, believed, corrected, ("recalibration", "viscous_damping"))
    assert np.max(np.abs(before[0])) > 100.0
    assert np.max(np.abs(left - 500.0 * rate)) < 10.0


def test_noise_that_is_louder_in_motion_is_no_place() -> None:
    """Of noise ten times as large while the tire moves, every sample is judged by that of its own state."""
    time = np.arange(0.0, 100.0, 0.02)
    moves = time % 10.0 < 2.0
    drive = read(
        "holds", time, np.interp(time % 10.0, [0.0, 2.0], [0.0, 0.02]), np.zeros(time.size), 4, noise=0.0
    )
    along = np.where(moves, 10.0, 1.0) * LEVEL
    own = along * np.random.default_rng(3).standard_normal(time.size)
    dataset = raw_dataset_of([drive], TireModel())
    found = [localize([drive], dataset, [own], [n], None) for n in (along, np.full(time.size, LEVEL))]
    assert found[0] == ()
    assert found[1] != ()


def test_noise_that_wanders_is_no_place_where_the_correction_leaves_it():
    time, deflection, _ = ride(3)
    drive = read("ride", time, deflection, flat_force(deflection), 4, noise=0.0)
    dataset = raw_dataset_of([drive], TireModel())
    found, level = {True: 0, False: 0}, [np.full(time.size, LEVEL)]
    for seed in range(10):
        own = noise(seed, time.size) + 0.4 * noise(100 + seed, time.size, colour=0.999)
        for known in found:
            found[known] += bool(localize([drive], dataset, [own], level, [own] if known else None))
    # 0.4 noises that last a thousand samples: eight correlation times to a recording, which a level does not tell.
    assert found[False] >= 8
    assert found[True] <= 1


def test_single_samples_that_stand_out_are_no_place():
    def added(time, deflection, rate):
        force = np.zeros(time.size)
        force[[700, 2100, 4400]] = 20.0 * LEVEL
        return force

    assert not located(added)


@pytest.mark.parametrize("samples", [1, 4])
def test_what_shows_in_a_single_sample_alone_is_no_place(samples: int) -> None:
    # 7 times the noise beside a neighbour of 2.5: no test of neighbours tells that it stands out, and noise shows none
    # so large in 1e11 samples. In four samples it is no false reading.
    def added(t, x, v):
        force = np.zeros(t.size)
        force[4000 : 4000 + samples] = 7.0 * LEVEL
        force[3999] = force[4000 + samples] = 2.5 * LEVEL
        return force

    found = [s for s in located(added) if s.by == "time"]
    assert bool(found) == (samples > 1)


def test_the_size_of_a_place_is_its_error_beyond_the_noise_over_that():
    spans = located(lambda t, x, v: np.where((t > 4.0) & (t < 5.0), 4.0 * LEVEL, 0.0))
    # The error's square is 16 + 1 noises there, known to 10 % from 200 samples.
    assert abs(first(spans, "time").size - 4.0) < 0.4


def test_the_contract_of_a_place():
    entry = located(lambda t, x, v: 300.0 * v)[0].to_dict()
    keys = {"by", "from", "to", "unit", "label", "share", "samples", "mean_residual", "size", "chance"}
    assert set(entry) == keys
    json.dumps(entry, allow_nan=False)


def test_places_are_told_by_concentration():
    spans = located(lambda t, x, v: 300.0 * v + np.where((t > 12.0) & (t < 12.6), 20.0, 0.0))
    ranks = [s.concentration for s in spans]
    assert ranks == sorted(ranks, reverse=True)
    # 300 v is the larger part of the error: fast motion comes first, the 20 N in time after it.
    assert spans[0].by == "rate"
    # Right after them the tire is pressed quickly: the same sign and size for a quarter of a second more.
    assert overlap(first(spans, "time"), 12.0, 12.6) > 0.65
