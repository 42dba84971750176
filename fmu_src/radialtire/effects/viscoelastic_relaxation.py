"""Rubber that relaxes: a fast deflection produces more force, which then decays (standard linear solids).

    F = F_elastic (1 - r (g1 + ... + g5)) + g1 h1 + ... + g5 h5,    dh_i/dt = dF_elastic/dt - h_i / tau_i

A Prony series on the elastic force (quasi-linear viscoelasticity). g_i is the fraction of the elastic force that term
i adds in a sudden deflection, tau_i its relaxation time. r says which force the elastic law is: r = 0 the slow one
(fully relaxed, as in a press of 30 s), r = 1 the sudden one. Integrated exactly for an elastic force that is linear
between two samples. F_elastic is without the preload of a part, which has relaxed.

    h_i = F_elastic exp(-t0 / tau_i) at the first sample,    f = tau_1 / (tau_1 + t0)

A recording need not begin at rest: it may be cut from a longer one, or begin in a hold. t0 is the time for which the
first sample's deflection had been held after a sudden deflection; where that took a while, t0 counts from its middle,
to the second order of its time over tau_i. The freshness f is 0 where all has relaxed, 1/2 where it was held for tau_1,
1 where it was just reached. It belongs to the recordings, one value to all of them: without a force at the first sample
it changes nothing.

The storage part of one term is g (w tau)^2 / (1 + (w tau)^2), the loss part g w tau / (1 + (w tau)^2), greatest at
w tau = 1. Rubber has relaxation times over several decades: about one term per decade follows a power of the
time. No published values for bicycle tires were found: the bounds are wide.

Reference: Y. C. Fung, "Biomechanics: Mechanical Properties of Living Tissues", Springer 1981, section 7.6.
"""

from __future__ import annotations

import math

from ..effect import Effect, Flow, Instant, LookAlike, State
from ..parameter import Parameter
from ..prior import Prior


def overstress(h: float, change: float, interval: float, tau: float) -> float:
    """Return h after `interval` [s] in which the elastic force changed linearly by `change` [N]."""
    passed = interval / tau
    if passed == 0.0:
        return h + change
    decay = -math.expm1(-passed)
    return h * (1.0 - decay) + change * decay / passed


def time_held(freshness: float, tau: float) -> float:
    """Return t0 [s] for a freshness above 0 and the first relaxation time [s]."""
    return tau * (1.0 / freshness - 1.0)


def left(elastic: float, held: float, tau: float) -> float:
    """Return h [N] of an elastic force [N] that was reached at once and held for a time [s]."""
    return elastic * math.exp(-held / tau)


def respond(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the overstress [N]; the state holds the last elastic force and the five overstresses."""
    g1, tau1, g2, tau2, g3, tau3, sudden, g4, tau4, g5, tau5, freshness = values
    elastic = instant.elastic_force - instant.preload
    last, h1, h2, h3, h4, h5 = state
    if instant.first:
        last = elastic
        if freshness > 0.0:
            held = time_held(freshness, tau1)
            h1, h2, h3 = left(elastic, held, tau1), left(elastic, held, tau2), left(elastic, held, tau3)
            h4, h5 = left(elastic, held, tau4), left(elastic, held, tau5)
    change = elastic - last
    h1 = overstress(h1, change, instant.interval, tau1)
    if g2 != 0.0:
        h2 = overstress(h2, change, instant.interval, tau2)
    if g3 != 0.0:
        h3 = overstress(h3, change, instant.interval, tau3)
    if g4 != 0.0:
        h4 = overstress(h4, change, instant.interval, tau4)
    if g5 != 0.0:
        h5 = overstress(h5, change, instant.interval, tau5)
    added = g1 * h1 + g2 * h2 + g3 * h3 + g4 * h4 + g5 * h5
    if sudden != 0.0:
        added -= sudden * (g1 + g2 + g3 + g4 + g5) * elastic
    return signal + added, (elastic, h1, h2, h3, h4, h5)


def flow(signal: float, instant: Instant, state: State, values: State) -> tuple[float, State]:
    """Add the overstress [N] with q_i = F_elastic - h_i for a solver: dq_i/dt = (F_elastic - q_i) / tau_i."""
    g1, tau1, g2, tau2, g3, tau3, sudden, g4, tau4, g5, tau5, freshness = values
    elastic = instant.elastic_force - instant.preload
    _, q1, q2, q3, q4, q5 = state
    if instant.first:
        q1, q2, q3, q4, q5 = elastic, elastic, elastic, elastic, elastic
        if freshness > 0.0:
            held = time_held(freshness, tau1)
            q1, q2 = q1 - left(elastic, held, tau1), q2 - left(elastic, held, tau2)
            q3 = q3 - left(elastic, held, tau3)
            q4, q5 = q4 - left(elastic, held, tau4), q5 - left(elastic, held, tau5)
    h1, h2, h3, h4, h5 = elastic - q1, elastic - q2, elastic - q3, elastic - q4, elastic - q5
    added = g1 * h1 + g2 * h2 + g3 * h3 + g4 * h4 + g5 * h5 - sudden * (g1 + g2 + g3 + g4 + g5) * elastic
    if instant.first:
        return signal + added, (0.0, q1, q2, q3, q4, q5)
    return signal + added, (0.0, h1 / tau1, h2 / tau2, h3 / tau3, h4 / tau4, h5 / tau5)


VISCOELASTIC_RELAXATION = Effect(
    name="viscoelastic_relaxation",
    place="parallel",
    parameters=(
        Parameter(
            "share_1",
            "g1",
            "1",
            0.0,
            0.0,
            5.0,
            "fraction that decays with the first time",
            neutral=0.0,
            nominal=0.05,
            role="strength",
            prior=Prior("log", 0.05, math.log(4)),
        ),
        Parameter(
            "relaxation_time_1",
            "tau1",
            "s",
            1.0,
            1e-7,
            1e8,
            "first relaxation time",
            prior=Prior("log", 0.03, math.log(8), "duration", "rubber relaxes over several decades of time"),
        ),
        Parameter(
            "share_2",
            "g2",
            "1",
            0.0,
            0.0,
            5.0,
            "fraction of the second time",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.3),
        ),
        Parameter(
            "relaxation_time_2",
            "tau2",
            "s",
            10.0,
            1e-7,
            1e8,
            "second relaxation time",
            optional=True,
            prior=Prior("log", 0.3, math.log(3), "duration"),
        ),
        Parameter(
            "share_3",
            "g3",
            "1",
            0.0,
            0.0,
            5.0,
            "fraction of the third time",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.3),
        ),
        Parameter(
            "relaxation_time_3",
            "tau3",
            "s",
            0.1,
            1e-7,
            1e8,
            "third relaxation time",
            optional=True,
            prior=Prior("log", 0.003, math.log(3), "duration"),
        ),
        Parameter(
            "sudden",
            "r",
            "1",
            0.0,
            0.0,
            1.0,
            "0: the law is the slow force, 1: the sudden one",
            optional=True,
            prior=Prior("normal", 0, 0.5),
        ),
        Parameter(
            "share_4",
            "g4",
            "1",
            0.0,
            0.0,
            5.0,
            "fraction of the fourth time",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.3),
        ),
        Parameter(
            "relaxation_time_4",
            "tau4",
            "s",
            0.01,
            1e-7,
            1e8,
            "fourth relaxation time",
            optional=True,
            prior=Prior("log", 0.0003, math.log(3), "duration"),
        ),
        Parameter(
            "share_5",
            "g5",
            "1",
            0.0,
            0.0,
            5.0,
            "fraction of the fifth time",
            neutral=0.0,
            optional=True,
            prior=Prior("normal", 0, 0.3),
        ),
        Parameter(
            "relaxation_time_5",
            "tau5",
            "s",
            100.0,
            1e-7,
            1e8,
            "fifth relaxation time",
            optional=True,
            prior=Prior("log", 3.0, math.log(3), "duration"),
        ),
        Parameter(
            "freshness",
            "f",
            "1",
            0.0,
            0.0,
            1.0,
            "at the first sample, 0: relaxed, 1: just deflected",
            optional=True,
            prior=Prior("normal", 0, 1, "1", "held for any time of the order of the first relaxation time"),
        ),
    ),
    initial_state=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    respond=respond,
    flow=Flow(
        flow,
        (1, 2, 3, 4, 5),
        ("relaxed_1", "relaxed_2", "relaxed_3", "relaxed_4", "relaxed_5"),
        ("N", "N", "N", "N", "N"),
        whole=0,
    ),
    statement="the force relaxes: it is higher after a fast deflection and decays while it is held",
    tell_tale="the force decays in a hold; the loop's area peaks where the frequency is 1 / (2 pi tau)",
    imitators=("viscous_damping", "rate_independent_hysteresis", "pressure_leak", "recalibration"),
    source="Fung 1981, section 7.6; no magnitude for bicycle tires was found, bounds wide",
    look_alike=LookAlike("a load cell or a fixture that creeps", "hold a steel spring in its place, as long"),
    traits=("rate", "loop", "rest"),
    form_error=0.0089,
)
