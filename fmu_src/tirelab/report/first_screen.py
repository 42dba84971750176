"""What a reader needs in ten seconds: what is missing, how sure that is, how much it helps, what to do next."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from radialtire import CATALOGUE

from ..names import REFITTED_LAW, UNKNOWN, plain
from . import titles, words
from .delivered import delivered_of

MOST = 70
"""Most characters of a headline."""

SURE = 0.9
"""From this confidence on a tire whose error is noise can be used as it is."""

LONGEST_LEAD = 100
"""Most characters of the sentences on two effects; if they are longer, only that on the larger effect is shown."""

WORSE = 1.05
"""A held-out error that grows by more than this factor is reported as worse."""


NOISE_FREE = {"after": "after_noise_free", "held_out_after": "held_out_noise_free"}
"""For each error, the name of the one with the noise-free deflection."""


@dataclass(frozen=True)
class Figure:
    """One error [N] with its title; alarm: why it is a bad one, empty where it is not; note: what it was."""

    title: str
    value: float
    alarm: str = ""
    note: str = ""


@dataclass(frozen=True)
class NextStep:
    """What to do next, as an action; why: what it decides; drive: whether it is the motion of the drive file."""

    action: str
    why: str = ""
    drive: bool = False


def headline(diagnosis: Mapping[str, Any]) -> str:
    """Return what was found in one line of at most MOST characters.

    diagnosis: the content of diagnosis.json; without sizes and load the line names the effects alone
    """
    return next((line for line in _headlines(diagnosis) if len(line) <= MOST), "Several effects are missing")


def undecided(verdict: Mapping[str, Any]) -> bool:
    """Return whether the recordings do not decide between the verdict and its alternatives."""
    same = [d["probability"] or 0.0 for d in verdict.get("alternative_details") or [] if d.get("same")]
    return bool(verdict["alternatives"]) and words.is_undecided(verdict["confidence"], same)


def sureness(verdict: Mapping[str, Any]) -> str:
    """Return how sure the verdict is, in words and as a number."""
    if contradiction := verdict.get("contradiction"):
        return f"{contradiction['question']}: {words.percent(verdict['confidence'])}"
    word = words.confidence_word(verdict["confidence"])
    return f"{word[0].upper()}{word[1:]}: {words.percent(verdict['confidence'])}"


def lead(diagnosis: Mapping[str, Any]) -> str:
    """Return one sentence on what is missing, after the headline."""
    verdict = diagnosis["verdict"]
    if verdict.get("contradiction"):
        return str(verdict["contradiction"]["finding"])
    names = [effect["name"] for effect in _by_size(verdict["effects"])]
    physics = [words.sentence(CATALOGUE[name].statement) for name in names if name in CATALOGUE]
    if undecided(verdict):
        others = [d["probability"] or 0.0 for d in verdict.get("alternative_details", [])]
        shown = words.beside_alternatives(verdict["confidence"], others)
        sure = [words.sentence(CATALOGUE[name].statement) for name in _sure(verdict) if name in CATALOGUE]
        if sure:
            return f"{sure[0]} These recordings cannot decide what else acts; {shown}."
        return f"These recordings cannot decide between the explanations; {shown}."
    if physics:
        both = " ".join(physics[:2])
        said = both if len(both) <= LONGEST_LEAD else physics[0]
        changed = all(e.get("in_baseline") for e in verdict["effects"] if e["name"] in CATALOGUE)
        return f"{said} The simulation has it, with other values." if changed else said
    if verdict["unexplained"]:
        return "No known effect explains the difference."
    if names and _left_over(diagnosis):
        return "Other coefficients of the elastic law explain part of the error; what is left is more than the noise."
    if names:
        if delivered_of(diagnosis).beside:
            return "The simulation's law fits the part with other coefficients: no physics is missing."
        return "The law fits the tire with other coefficients: no physics is missing."
    if verdict.get("not_compared"):
        return "Where the gauges follow, the difference between simulation and recordings is noise."
    if _left_over(diagnosis):
        return "Apart from single outliers, the difference between simulation and recordings is noise."
    return "The difference between simulation and recordings is noise."


def figures(diagnosis: Mapping[str, Any]) -> list[Figure]:
    """Return the errors before, after, on held-out data, and the noise floor."""
    fit, verdict = diagnosis["fit"], diagnosis["verdict"]
    noise = fit["noise"]
    if verdict["effects"]:
        shown = [
            Figure("Error before", fit["before"]),
            Figure("Error after", fit["after"], *_alarm_and_note(fit, "after")),
        ]
    else:
        shown = [Figure("Error", fit["before"], _left(fit["before"], noise))]
    if fit["held_out_after"] is not None:
        (alarm, own), was = _alarm_and_note(fit, "held_out_after"), fit["held_out_before"]
        if was is not None and fit["held_out_after"] > WORSE * was:
            alarm = "worse than before"
        note = f"from {words.number(was)} N" if was is not None and verdict["effects"] else ""
        shown.append(Figure("Held-out", fit["held_out_after"], alarm, "; ".join(filter(None, (note, own)))))
    return [*shown, Figure("Noise floor", noise)]


def next_step(diagnosis: Mapping[str, Any], reasons: Sequence[str] = ()) -> NextStep:
    """Return what to do next: one recording within the rig's limits, or nothing.

    reasons: of each alternative what the recordings lack, as "lack: action"
    """
    verdict, fit, given = diagnosis["verdict"], diagnosis["fit"], delivered_of(diagnosis)
    if contradiction := verdict.get("contradiction"):
        return NextStep(contradiction["action"], contradiction["caution"])
    test = verdict["separating_test"]
    errors = [
        e for e in (_beside_reading(fit, "after"), _beside_reading(fit, "held_out_after")) if e is not None
    ]
    clean = not verdict["unexplained"] and not titles.more_than_noise(max(errors), fit["noise"])
    if words.whole_percent(verdict["confidence"]) >= SURE and clean:
        surer = f"To be surer still, drive {test['file']}." if test else ""
        said = [_left_in_order(verdict), *verdict.get("not_compared", []), surer]
        return NextStep(given.use if verdict["effects"] else given.leave, " ".join(filter(None, said)))
    if test is not None:
        return NextStep(_drive(test), _decides(test, verdict), drive=True)
    found = actions(reasons) if verdict["alternatives"] else []
    if verdict["unexplained"] and not (undecided(verdict) and found):
        return NextStep(
            f"Repeat one recording with another {given.kind}.",
            f"If the same difference comes back, the rig causes it, not the {given.kind}.",
        )
    if found:
        return NextStep(
            f"{_capital(found[0])}.",
            "No other motion of this rig on these surfaces decides between the alternatives.",
        )
    if not clean:
        return NextStep(
            f"Repeat one recording with another {given.kind}.",
            "The remaining error is larger than the noise: if it comes back, the rig causes it.",
        )
    said = [_left_in_order(verdict), _as_good(verdict)]
    return NextStep(given.use if verdict["effects"] else given.leave, " ".join(filter(None, said)))


def _as_good(verdict: Mapping[str, Any]) -> str:
    """Return why nothing is to be done though there are alternatives; empty where there are none."""
    if not verdict["alternatives"]:
        return ""
    force = "the corrected force" if verdict["effects"] else "the baseline's force"
    either = "either" if len(verdict["alternatives"]) == 1 else "any of them"
    return f"No motion of this rig decides between the alternatives; {force} is equally good with {either}."


def _left_in_order(verdict: Mapping[str, Any]) -> str:
    """Return what is left beside the noise though the tire can be used, if that depends on anything."""
    left = verdict.get("remainder", {})
    by = [titles.dependence(d["by"]) for d in left.get("depends_on", [])]
    if not by:
        return ""
    return f"The remainder, {plain(left['size'], 2)} times the noise, depends on {titles.listed(by)}."


def actions(reasons: Sequence[str]) -> list[str]:
    """Return the actions of sentences such as "no hold: hold 10 s at 15 mm", each once, in their order."""
    found = [part.partition(": ")[2].strip() for reason in reasons for part in reason.split("; ")]
    return list(dict.fromkeys(action for action in found if action))


def _headlines(diagnosis: Mapping[str, Any]) -> Iterator[str]:
    """Yield headlines from the fullest to the shortest."""
    verdict = diagnosis["verdict"]
    if verdict.get("contradiction"):
        yield verdict["contradiction"]["headline"]
        yield "The recordings contradict each other"
        return
    if undecided(verdict):
        yield from _undecided(verdict)
        return
    physics = [e for e in verdict["effects"] if e["name"] != REFITTED_LAW]
    refitted = len(physics) < len(verdict["effects"])
    parts = [
        (_short(e), words.of_load(e.get("size"), diagnosis["fit"].get("load"))) for e in _by_size(physics)
    ]
    if verdict["unexplained"]:
        rms = verdict.get("remainder", {}).get("rms")
        parts.append((titles.effect_title(UNKNOWN), words.of_load(rms, diagnosis["fit"].get("load"))))
    if not parts:
        if refitted and _left_over(diagnosis):
            yield "The law is refitted, and more than the noise is left"
        yield "No other physics shows: the law is refitted" if refitted else "Nothing is missing"
        return
    law = "; law refitted" if refitted else ""
    if len(parts) == 1:
        (name, share) = parts[0]
        yield _capital(f"{name}, {share} of the load{law}" if share else f"{name}{law}")
        yield _capital(f"{name}{law}")
        return
    if all(share for _, share in parts):
        yield _capital(f"{titles.listed([f'{name} {share}' for name, share in parts])} of the load{law}")
    yield _capital(f"{titles.listed([name for name, _ in parts])}{law}")
    for shown in range(len(parts) - 1, 0, -1):
        others = len(parts) - shown
        more = f"{others} more effect{'s' if others > 1 else ''}"
        yield _capital(f"{titles.listed([*(name for name, _ in parts[:shown]), more])}{law}")


def _short(effect: Mapping[str, Any]) -> str:
    """Return the short title of an effect, with a remark where the baseline has it too."""
    title = titles.short_title(effect["name"])
    return f"{title} (other values)" if effect.get("in_baseline") else title


def _left_over(diagnosis: Mapping[str, Any]) -> bool:
    fit = diagnosis["fit"]
    return titles.more_than_noise(_beside_reading(fit, "after") or 0.0, fit["noise"])


def _beside_reading(fit: Mapping[str, Any], error: str) -> float | None:
    """Return an error [N], or what is left of it where the tire is given the noise-free deflection, if that is less."""
    noise_free = fit.get(NOISE_FREE[error])
    if fit[error] is None or noise_free is None:
        return fit[error]  # type: ignore[no-any-return]
    return float(min(fit[error], noise_free))


def _by_size(effects: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    return sorted(effects, key=lambda e: -(e.get("size") or 0.0))


def _sure(verdict: Mapping[str, Any]) -> list[str]:
    """Return the effects that are as good as certain by themselves, whatever acts beside them."""
    return _at_least(verdict, SURE)


def _at_least(verdict: Mapping[str, Any], least: float) -> list[str]:
    """Return the effects with that probability of their own, the largest first."""
    return [
        e["name"]
        for e in _by_size(verdict["effects"])
        if words.whole_percent(e.get("probability") or 0.0) >= least
    ]


def _undecided(verdict: Mapping[str, Any]) -> Iterator[str]:
    own = [e["name"] for e in verdict["effects"]] + ([UNKNOWN] if verdict["unexplained"] else [])
    sets = [titles.short_set(own)]
    alternatives = verdict["alternatives"]
    details = verdict.get("alternative_details") or []
    if len(details) == len(alternatives):
        pairs = [{**d, "names": names} for d, names in zip(details, alternatives, strict=True)]
        if not words.is_undecided(verdict["confidence"], ()):
            least = words.NEAR * verdict["confidence"]
            pairs = [p for p in pairs if p.get("same") and (p["probability"] or 0.0) >= least]
        alternatives = [pair["names"] for pair in words.likeliest(pairs)]
    if sure := _sure(verdict):
        beside_sure = [own, *(names for names in alternatives if set(sure) <= set(names))]
        yield from _beside(
            sure, [n for n in _at_least(verdict, words.LIKELIER) if n not in sure], beside_sure
        )
        return
    for names in alternatives:
        added = [name for name in names if name not in own]
        beside = bool(own) and set(own) < set(names)
        sets.append(f"+ {titles.short_set(added)}" if beside else titles.short_set(names))
    yield f"Undecided: {titles.listed(sets, 'or')}"
    likely = [titles.short_title(name) for name in _at_least(verdict, words.LIKELIER)]
    for shown in range(len(sets) - 1, 0, -1):
        if shown == 1 and likely:
            each = "each " if len(likely) > 1 else ""
            yield f"Undecided; {each}more likely than not: {titles.listed(likely)}"
        others = len(sets) - shown
        more = f"{others} other{'s' if others > 1 else ''}"
        yield f"Undecided: {titles.listed([*sets[:shown], more], 'or')}"
    yield f"Undecided between {len(sets)} explanations"


def _beside(sure: Sequence[str], likely: Sequence[str], sets: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield what is sure and what may act beside it, from the fullest line to the shortest; likely: what is likelier
    than not.
    """
    found = _capital(titles.listed([titles.short_title(name) for name in sure]))
    if likely:
        each = "each " if len(likely) > 1 else ""
        yield f"{found}; {each}more likely than not: {titles.listed([titles.short_title(n) for n in likely])}"
    also = list(dict.fromkeys(titles.short_title(n) for names in sets for n in names if n not in sure))
    for shown in range(len(also), 0, -1):
        others = len(also) - shown
        more = [f"{others} other{'s' if others > 1 else ''}"] if others else []
        yield f"{found}; undecided: {titles.listed([*also[:shown], *more], 'or')}"
    yield f"{found}; undecided what else acts"


def _alarm_and_note(fit: Mapping[str, Any], error: str) -> tuple[str, str]:
    """Return the alarm of an error, and a note where it is noise of the reading alone."""
    noise = fit["noise"]
    noise_free = _beside_reading(fit, error)
    if _left(fit[error], noise) and not _left(noise_free, noise) and noise_free is not None:
        return "", f"{words.number(noise_free)} N without the noise of the reading"
    return _left(noise_free, noise), ""


def _left(after: float | None, noise: float) -> str:
    if after is None or noise <= 0.0 or not titles.more_than_noise(after, noise):
        return ""
    return f"{words.number(after / noise, 2)} × the noise"


def _drive(test: Mapping[str, Any]) -> str:
    """Return the recommended recording in one sentence; the one of diagnosis.json where it is not complete."""
    keys = ("waveform", "amplitude", "rate_max", "duration", "surfaces")
    if any(test.get(key) is None for key in keys):
        return str(test.get("sentence", ""))
    place = titles.listed([f" on {words.on_surface(radius)}" for radius in test["surfaces"]])
    first, last = words.edges(test.get("begins_at") or 0.0, test["amplitude"], 1e3)
    begins = "" if first == "0" else f" from {first}"
    return (
        f"Record {test['waveform']}{begins} to {last} mm{place}, at up to "
        f"{words.number(1e3 * test['rate_max'])} mm/s, for {words.number(test['duration'], 2)} s."
    )


def _decides(test: Mapping[str, Any], verdict: Mapping[str, Any]) -> str:
    """Return what the recommended recording decides, by what differs between the two sets."""
    if not test.get("between"):
        return ""
    own = {effect["name"] for effect in verdict["effects"]}
    extra = [UNKNOWN] if verdict["unexplained"] else []
    first, second = ([*names, *(extra if set(names) == own else [])] for names in test["between"])
    too = " too" if first and set(first) < set(second) else ""
    asked = titles.question(first, second, too)
    return f"It decides {asked}." if asked else ""


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
