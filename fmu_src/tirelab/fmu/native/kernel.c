/* The step of a bicycle tire. Made from the Python of radialtire; change that, not this. */
#include "kernel.h"

#include <math.h>
#include <stdbool.h>

static const double AHEAD = 1e-06;
static const double APART = 1000000.0;
static const double CM_PER_M = 100.0;
static const double DEAD_PART = 0.005;
static const double DEPTH = 0.01;
static const double EVEN = 1e-09;
static const double EXACT = 1e-12;
static const double FADES = 0.5;
static const double FAR = 40.0;
static const double FINEST = 1e-06;
static const double FLAT_COEFFICIENT = 550.9;
static const double FLAT_EXPONENT = 1.422;
static const double FLAT_RADIUS = 100000.0;
static const double HULL1996 = 0.0;
static const double JERK_MAX = 32.0;
static const double LEAST_CURVATURE = 0.05;
static const double LOST_MAX = 0.9;
static const double NEAR = 1e-09;
static const double NEARLY_CRITICAL = 1e-05;
static const double NO_LIMIT = 1000000000.0;
static const double NO_TIME = 1e-09;
static const double PAUSE = 10.0;
static const double POWER_LAW = 1.0;
static const double PRESS = 0.0001;
static const double REFERENCE = 0.025;
static const double RELEASED = 0.001;
static const double RIDE = 10.0;
static const double SHARP = 10000000.0;
static const double SMOOTH = 100.0;
static const double SNAP_MAX = 128.0;
static const double SOONEST = 1e-30;
static const double SPEED = 0.1;
static const double STEEPEST = 300.0;
static const double SWITCH = 0.02;
static const double TAIL = 4.0;
static const double TANGENT_STEP = 1e-07;
static const double UNIT = 0.001;
static const double UNKNOWN = 10000.0;
static const double VISCOUS_DAMPING_NEAR = 1e-05;
static const double WARMING = 10.0;
static const double WHEEL_RADIUS = 0.33;

typedef struct { double v[14]; } Vector14;
typedef struct { Vector14 v[4]; } Vector14x4;
typedef struct { double v[4]; } Vector4;
typedef struct { Vector14x4 a; Vector4 b; double c; } Tuple3;
typedef struct { double a; double b; bool c; double d; double e; bool f; double g; double h; double i; } Tuple4;
typedef struct { double v[3]; } Vector3;
typedef struct { double time; double interval; bool first; double deflection; double rate; double acceleration; double coefficient; double exponent; double elastic_force; double curvature; double pressure; double temperature; bool two_sided; double preload; } Instant;
typedef struct { char unused; } Nothing;
typedef struct { double a; Nothing b; } Tuple8;
typedef struct { double v[1]; } Vector1;
typedef struct { double a; Vector1 b; } Tuple11;
typedef struct { double v[13]; } Vector13;
typedef struct { double v[12]; } Vector12;
typedef struct { double v[5]; } Vector5;
typedef struct { double a; Vector3 b; } Tuple15;
typedef struct { double v[8]; } Vector8;
typedef struct { double a; Vector8 b; } Tuple18;
typedef struct { double v[6]; } Vector6;
typedef struct { double a; Vector6 b; } Tuple20;
typedef struct { double v[16]; } Vector16;
typedef struct { double v[32]; } Vector32;
typedef struct { double a; Vector32 b; } Tuple23;
typedef struct { double v[35]; } Vector35;
typedef struct { double a; Vector35 b; } Tuple25;
typedef struct { double v[10]; } Vector10;
typedef struct { double v[18]; } Vector18;

const double REST[STATES] = {0};

/* min and max as Python has them, also with NaN. */
static inline double lesser(double a, double b) { return b < a ? b : a; }
static inline double greater(double a, double b) { return b > a ? b : a; }

/* power_law.py: Return the radial force [N] of a tire compressed by `deflection` [m]. */
double tire_elastic(double deflection, double coefficient, double exponent)
{
    if (deflection <= 0.0) {
        return 0.0;
    }
    double result = coefficient * pow(CM_PER_M * deflection, exponent);
    return result;
}

/* power_law.py: Return the tangent dF/dx [N/m] of `force` at `deflection` [m]: A B x^(B-1), 0 where the tire is not
   loaded. */
double tire_elastic_tangent(double deflection, double coefficient, double exponent)
{
    if (deflection <= 0.0) {
        return 0.0;
    }
    double result = coefficient * exponent * pow(CM_PER_M * deflection, exponent - 1.0) * CM_PER_M;
    return result;
}

/* tracking.py: Return the track after the first measurement [m]. */
static inline Tuple3 tracking_begin(double deflection)
{
    Vector14 at = (Vector14){{deflection, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
    return (Tuple3){(Vector14x4){{at, at, at, at}}, (Vector4){{0.25, 0.25, 0.25, 0.25}}, 0.0};
}

/* tracking.py: Return the motion in each mode at the second sample, from the difference v of the two. */
static inline Vector14x4 tracking_second(double x, double v)
{
    double u = UNKNOWN;
    Vector14 jerked = (Vector14){{x, v, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0 + u, u, 0.0, u, 0.0, 0.0}};
    Vector14 snapped = (Vector14){{x, v, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0 + 2.0 * u, u, -u, u, 0.0, u}};
    return (Vector14x4){{jerked, jerked, snapped, snapped}};
}

/* tracking.py: Return the motion with its times scaled by r times the scale before. */
static inline Vector14 tracking_scaled(Vector14 moving, double r)
{
    if (r == 1.0) {
        return moving;
    }
    double x = moving.v[0], v = moving.v[1], a = moving.v[2], j = moving.v[3], p00 = moving.v[4], p01 = moving.v[5],
        p02 = moving.v[6], p03 = moving.v[7], p11 = moving.v[8], p12 = moving.v[9], p13 = moving.v[10], p22 =
        moving.v[11], p23 = moving.v[12], p33 = moving.v[13];
    double rr = r * r;
    double rrr = rr * r;
    return (Vector14){{x, v * r, a * rr, j * rrr, p00, p01 * r, p02 * rr, p03 * rrr, p11 * rr, p12 * rrr, p13 * rr *
        rr, p22 * rr * rr, p23 * rr * rrr, p33 * rrr * rrr}};
}

/* tracking.py: Return the motion predicted one interval ahead, which is r times the scale before and the scale now.
   */
static inline Vector14 tracking_predicted(Vector14 moving, double r)
{
    const Vector14 t1 = tracking_scaled(moving, r);
    double x = t1.v[0], v = t1.v[1], a = t1.v[2], j = t1.v[3], p00 = t1.v[4], p01 = t1.v[5], p02 = t1.v[6], p03 =
        t1.v[7], p11 = t1.v[8], p12 = t1.v[9], p13 = t1.v[10], p22 = t1.v[11], p23 = t1.v[12], p33 = t1.v[13];
    double q00 = p00 + p01 + p02 + p03;
    double q01 = p01 + p11 + p12 + p13;
    double q02 = p02 + p12 + p22 + p23;
    double q03 = p03 + p13 + p23 + p33;
    double q11 = p11 + 2.0 * p12 + 3.0 * p13;
    double q12 = p12 + 2.0 * p22 + 3.0 * p23;
    double q13 = p13 + 2.0 * p23 + 3.0 * p33;
    double q22 = p22 + 3.0 * p23;
    double q23 = p23 + 3.0 * p33;
    return (Vector14){{x + v + a + j, v + 2.0 * a + 3.0 * j, a + 3.0 * j, j, q00 + q01 + q02 + q03, q01 + 2.0 * q02
        + 3.0 * q03, q02 + 3.0 * q03, q03, q11 + 2.0 * q12 + 3.0 * q13, q12 + 3.0 * q13, q13, q22 + 3.0 * q23, q23,
        p33}};
}

/* tracking.py: Return the largest intensity of the jerk, scaled by an interval that is `part` of the scale d. */
static inline double tracking_jerk_max(double part)
{
    return JERK_MAX * part * part * part * part * part;
}

/* tracking.py: Return the motion after an interval of white jerk of scaled intensity q; the jerk itself is not
   estimated. */
static inline Vector14 tracking_jerked(Vector14 moving, double q)
{
    double x = moving.v[0], v = moving.v[1], a = moving.v[2], p00 = moving.v[4], p01 = moving.v[5], p02 =
        moving.v[6], p11 = moving.v[8], p12 = moving.v[9], p22 = moving.v[11];
    return (Vector14){{x, v, a, 0.0, p00 + q / 20.0, p01 + q / 8.0, p02 + q / 12.0, 0.0, p11 + q / 3.0, p12 + q /
        4.0, 0.0, p22 + q / 4.0, 0.0, 0.0}};
}

/* tracking.py: Return the largest intensity of the jerk's rate, scaled by an interval that is `part` of the scale
   d. */
static inline double tracking_snap_max(double part)
{
    return SNAP_MAX * part * part * part * part * part * part * part;
}

/* tracking.py: Return the motion after an interval in which the jerk's rate was white, of scaled intensity q. */
static inline Vector14 tracking_snapped(Vector14 moving, double q)
{
    double x = moving.v[0], v = moving.v[1], a = moving.v[2], j = moving.v[3], p00 = moving.v[4], p01 = moving.v[5],
        p02 = moving.v[6], p03 = moving.v[7], p11 = moving.v[8], p12 = moving.v[9], p13 = moving.v[10], p22 =
        moving.v[11], p23 = moving.v[12], p33 = moving.v[13];
    return (Vector14){{x, v, a, j, p00 + q / 252.0, p01 + q / 72.0, p02 + q / 60.0, p03 + q / 144.0, p11 + q / 20.0,
        p12 + q / 16.0, p13 + q / 36.0, p22 + q / 12.0, p23 + q / 24.0, p33 + q / 36.0}};
}

/* tracking.py: Return the likelihood of an exact measurement [m], up to a factor that all modes share. */
static inline double tracking_exact_likelihood(Vector14 moving, double deflection)
{
    double spread = moving.v[4] + 1.0;
    double innovation = deflection - moving.v[0];
    return pow(innovation * innovation / spread + EXACT * EXACT, -0.5 * (TAIL + 1.0)) / sqrt(spread);
}

/* tracking.py: Return the motion updated with a measurement [m]. */
static inline Vector14 tracking_updated(Vector14 moving, double deflection)
{
    double x = moving.v[0], v = moving.v[1], a = moving.v[2], j = moving.v[3], p00 = moving.v[4], p01 = moving.v[5],
        p02 = moving.v[6], p03 = moving.v[7], p11 = moving.v[8], p12 = moving.v[9], p13 = moving.v[10], p22 =
        moving.v[11], p23 = moving.v[12], p33 = moving.v[13];
    double spread = p00 + 1.0;
    double k0 = p00 / spread;
    double k1 = p01 / spread;
    double k2 = p02 / spread;
    double k3 = p03 / spread;
    double innovation = deflection - x;
    return (Vector14){{x + k0 * innovation, v + k1 * innovation, a + k2 * innovation, j + k3 * innovation, k0, k1,
        k2, k3, p11 - k1 * p01, p12 - k1 * p02, p13 - k1 * p03, p22 - k2 * p02, p23 - k2 * p03, p33 - k3 * p03}};
}

/* tracking.py: Return the track after an exact measurement: two filters of the shortest memory, each for itself. */
static inline Tuple3 tracking_exactly(Vector14x4 modes, Vector4 probability, double ratio, double part, double
    deflection, double scale)
{
    Vector14 ride = tracking_jerked(tracking_predicted(modes.v[1], ratio), tracking_jerk_max(part));
    Vector14 sharp = tracking_snapped(tracking_predicted(modes.v[3], ratio), tracking_snap_max(part));
    double before = SWITCH + (1.0 - 2.0 * SWITCH) * probability.v[3] / (probability.v[1] + probability.v[3]);
    double w1 = (1.0 - before) * tracking_exact_likelihood(ride, deflection);
    double w3 = before * tracking_exact_likelihood(sharp, deflection);
    ride = tracking_scaled(tracking_updated(ride, deflection), 1.0 / part);
    sharp = tracking_scaled(tracking_updated(sharp, deflection), 1.0 / part);
    return (Tuple3){(Vector14x4){{ride, ride, sharp, sharp}}, (Vector4){{0.0, w1 / (w1 + w3), 0.0, w3 / (w1 + w3)}},
        scale};
}

/* tracking.py: Return mean and covariance of a motion that is b with the probability `share`, and a otherwise. */
static inline Vector14 tracking_mixed(Vector14 a, Vector14 b, double share, double certainty)
{
    double remainder = 1.0 - share;
    double d0 = b.v[0] - a.v[0];
    double d1 = b.v[1] - a.v[1];
    double d2 = b.v[2] - a.v[2];
    double d3 = b.v[3] - a.v[3];
    double farthest = certainty * greater(greater(greater(d0 * d0, d1 * d1), d2 * d2), d3 * d3);
    double apart = remainder * share * (farthest < APART ? certainty : certainty * APART / farthest);
    return (Vector14){{a.v[0] + share * d0, a.v[1] + share * d1, a.v[2] + share * d2, a.v[3] + share * d3, remainder
        * a.v[4] + share * b.v[4] + apart * d0 * d0, remainder * a.v[5] + share * b.v[5] + apart * d0 * d1,
        remainder * a.v[6] + share * b.v[6] + apart * d0 * d2, remainder * a.v[7] + share * b.v[7] + apart * d0 *
        d3, remainder * a.v[8] + share * b.v[8] + apart * d1 * d1, remainder * a.v[9] + share * b.v[9] + apart * d1
        * d2, remainder * a.v[10] + share * b.v[10] + apart * d1 * d3, remainder * a.v[11] + share * b.v[11] + apart
        * d2 * d2, remainder * a.v[12] + share * b.v[12] + apart * d2 * d3, remainder * a.v[13] + share * b.v[13] +
        apart * d3 * d3}};
}

/* tracking.py: Return mean and covariance of the motion over all modes. */
static inline Vector14 tracking_mean(Vector14x4 modes, Vector4 probability, double certainty)
{
    Vector14 whole = modes.v[0];
    double weight = probability.v[0];
    for (int i = 1; i < 4; i++) {
        weight += probability.v[i];
        whole = tracking_mixed(whole, modes.v[i], weight > 0.0 ? probability.v[i] / weight : 0.0, certainty);
    }
    return whole;
}

/* tracking.py: Return the log likelihood of a measurement [m], without the terms that all modes share. */
static inline double tracking_log_likelihood(Vector14 moving, double deflection, double certainty)
{
    double spread = moving.v[4] + 1.0;
    double innovation = deflection - moving.v[0];
    return -0.5 * (log(spread) + (TAIL + 1.0) * log1p(innovation * innovation * certainty / (TAIL * spread)));
}

/* tracking.py: Return the track after a measurement `deflection` [m], `interval` > 0 [s] after the last one. */
static inline Tuple3 tracking_follow(Tuple3 track, double interval, double deflection, double noise)
{
    Vector14x4 modes = track.a;
    Vector4 probability = track.b;
    double last = track.c;
    if (last <= 0.0 || interval > PAUSE * last) {
        return (Tuple3){tracking_second(deflection, deflection - modes.v[0].v[0]), probability, interval};
    }
    double ratio = greater(interval / last, SOONEST);
    double scale = greater(interval, FADES * last);
    double part = ratio >= FADES ? 1.0 : ratio / FADES;
    if (noise < EXACT) {
        return tracking_exactly(modes, probability, ratio, part, deflection, scale);
    }
    double certainty = 1.0 / (noise * noise);
    double fifth = interval * interval * interval * interval * interval * certainty;
    double seventh = fifth * interval * interval;
    double smaller = lesser(noise / FINEST, 1.0);
    double part_of_tire = smaller * smaller;
    double jerk_max = tracking_jerk_max(part);
    double snap_max = tracking_snap_max(part);
    Vector14 whole = tracking_mean(modes, probability, certainty);
    double other = SWITCH / 3.0;
    double same = 1.0 - SWITCH - other;
    double c0 = other + same * probability.v[0];
    double c1 = other + same * probability.v[1];
    double c2 = other + same * probability.v[2];
    double c3 = other + same * probability.v[3];
    Vector14 press = tracking_predicted(tracking_mixed(modes.v[0], whole, other / c0, certainty), ratio);
    Vector14 ride = tracking_predicted(tracking_mixed(modes.v[1], whole, other / c1, certainty), ratio);
    Vector14 smooth = tracking_predicted(tracking_mixed(modes.v[2], whole, other / c2, certainty), ratio);
    Vector14 sharp = tracking_predicted(tracking_mixed(modes.v[3], whole, other / c3, certainty), ratio);
    press = tracking_jerked(press, lesser(PRESS * part_of_tire * fifth, jerk_max));
    ride = tracking_jerked(ride, lesser(RIDE * fifth, jerk_max));
    smooth = tracking_snapped(smooth, lesser(SMOOTH * part_of_tire * seventh, snap_max));
    sharp = tracking_snapped(sharp, lesser(SHARP * seventh, snap_max));
    double l0 = log(c0) + tracking_log_likelihood(press, deflection, certainty);
    double l1 = log(c1) + tracking_log_likelihood(ride, deflection, certainty);
    double l2 = log(c2) + tracking_log_likelihood(smooth, deflection, certainty);
    double l3 = log(c3) + tracking_log_likelihood(sharp, deflection, certainty);
    double best = greater(greater(greater(l0, l1), l2), l3);
    double w0 = exp(l0 - best);
    double w1 = exp(l1 - best);
    double w2 = exp(l2 - best);
    double w3 = exp(l3 - best);
    double total = w0 + w1 + w2 + w3;
    return (Tuple3){(Vector14x4){{tracking_scaled(tracking_updated(press, deflection), 1.0 / part),
        tracking_scaled(tracking_updated(ride, deflection), 1.0 / part), tracking_scaled(tracking_updated(smooth,
        deflection), 1.0 / part), tracking_scaled(tracking_updated(sharp, deflection), 1.0 / part)}}, (Vector4){{w0
        / total, w1 / total, w2 / total, w3 / total}}, scale};
}

/* flat_step.py: Return the track after a reading of `deflection` [m], `interval` [s] after the last one; noise [m].
   */
static inline Tuple3 tracked_track(const double *s, double deflection, double interval, double noise)
{
    if (s[4] == 0.0) {
        return tracking_begin(deflection);
    }
    Tuple3 before = (Tuple3){(Vector14x4){{*(const Vector14 *)(s + 61), *(const Vector14 *)(s + 75), *(const
        Vector14 *)(s + 89), *(const Vector14 *)(s + 103)}}, *(const Vector4 *)(s + 117), s[121]};
    if (interval > 0.0) {
        return tracking_follow(before, interval, deflection, noise);
    }
    return before;
}

/* flat_step.py: Write a track into a state. */
static inline void store_track(double *n, Tuple3 track)
{
    Vector14x4 modes = track.a;
    Vector4 probability = track.b;
    double last = track.c;
    for (int i = 0; i < 14; i++)
        n[61 + i] = modes.v[0].v[i];
    for (int i = 0; i < 14; i++)
        n[75 + i] = modes.v[1].v[i];
    for (int i = 0; i < 14; i++)
        n[89 + i] = modes.v[2].v[i];
    for (int i = 0; i < 14; i++)
        n[103 + i] = modes.v[3].v[i];
    for (int i = 0; i < 4; i++)
        n[117 + i] = probability.v[i];
    n[121] = last;
}

/* tracking.py: Return the rate [m/s] of the deflection at the last sample, 0 before the second one. */
static inline double tracking_rate(Tuple3 track)
{
    Vector14x4 modes = track.a;
    Vector4 probability = track.b;
    double last = track.c;
    if (last <= 0.0) {
        return 0.0;
    }
    double scaled = 0.0;
    for (int i = 0; i < 4; i++) {
        scaled += probability.v[i] * modes.v[i].v[1];
    }
    return scaled / last;
}

/* tracking.py: Return the acceleration [m/s^2] of the deflection at the last sample, 0 before the second one. */
static inline double tracking_acceleration(Tuple3 track)
{
    Vector14x4 modes = track.a;
    Vector4 probability = track.b;
    double last = track.c;
    if (last <= 0.0) {
        return 0.0;
    }
    double scaled = 0.0;
    for (int i = 0; i < 4; i++) {
        scaled += probability.v[i] * modes.v[i].v[2];
    }
    return 2.0 * scaled / (last * last);
}

/* effects.deflection_offset.py: Shift the deflection [m] by x0. */
static inline Tuple8 deflection_offset_respond(double signal, Instant instant, Nothing state, Vector1 values)
{
    return (Tuple8){signal + values.v[0], state};
}

/* effects.settling_drift.py: Return (1 - exp(-k t)) / k [s]: the time that a drift would take at its first rate. */
static inline double settling_drift_drift_time(double time, double settling)
{
    double settled = settling * time;
    if (settled <= EVEN) {
        return time;
    }
    return -time * expm1(-settled) / settled;
}

/* effects.deflection_drift.py: Shift the deflection [m] by the drift since the start. */
static inline Tuple8 deflection_drift_respond(double signal, Instant instant, Nothing state, Vector2 values)
{
    double drift = values.v[0], settling = values.v[1];
    return (Tuple8){signal + drift * settling_drift_drift_time(instant.time, settling), state};
}

/* effects.deflection_lag.py: Advance the deflection [m] by the lag of its channel. */
static inline Tuple8 deflection_lag_respond(double signal, Instant instant, Nothing state, Vector2 values)
{
    double tau = values.v[0], delta = values.v[1];
    double first_order = (tau + delta) * instant.rate;
    double second_order = delta * (tau + 0.5 * delta) * instant.acceleration;
    return (Tuple8){signal + first_order + second_order, state};
}

/* effects.permanent_set.py: Return the deflection [m] at which the law has the force; the state: largest deflection
   so far [m]. */
static inline Tuple11 permanent_set_respond(double signal, Instant instant, Vector1 state, Vector4 values)
{
    double share = values.v[0], power = values.v[1], onset = values.v[2], history = values.v[3];
    double largest = greater(instant.first ? history : state.v[0], signal);
    double stays = share * greater(largest - onset, 0.0);
    if (signal >= largest || stays <= 0.0) {
        return (Tuple11){signal, (Vector1){{largest}}};
    }
    if (signal <= stays) {
        return (Tuple11){signal - stays, (Vector1){{largest}}};
    }
    return (Tuple11){largest * pow((signal - stays) / (largest - stays), pow(power, share)), (Vector1){{largest}}};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_deflection(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[8] != 0.0) {
        const Tuple8 t1 = deflection_offset_respond(signal, at, (Nothing){0}, (Vector1){{p[9]}});
        signal = t1.a;
    }
    if (p[10] != 0.0) {
        const Tuple8 t2 = deflection_drift_respond(signal, at, (Nothing){0}, (Vector2){{p[11], p[12]}});
        signal = t2.a;
    }
    if (p[13] != 0.0) {
        const Tuple8 t3 = deflection_lag_respond(signal, at, (Nothing){0}, (Vector2){{p[14], p[15]}});
        signal = t3.a;
    }
    if (p[16] != 0.0) {
        const Tuple11 t4 = permanent_set_respond(signal, at, (Vector1){{s[6]}}, *(const Vector4 *)(p + 17));
        signal = t4.a;
        Vector1 after = t4.b;
        n[6] = after.v[0];
    }
    return signal;
}

/* effects.series_compliance.py: Return the tire's part of the deflection x [m] over a spring that stiffens; plain:
   over one that does not. */
static inline double series_compliance_stiffening(double x, double k, double h, double A, double B, double plain)
{
    double force;
    double miss;
    double slope;
    double following;
    bool near;
    double low = 0.0;
    double high = x - plain;
    double d = high < x ? high : 0.5 * x;
    for (int t1 = 0; t1 < 60; t1++) {
        if (x - d <= 0.0) {
            break;
        }
        force = A * pow(100.0 * (x - d), B);
        miss = d * (1.0 + h * d) - k * force;
        if (miss > 0.0) {
            high = d;
        } else {
            low = d;
        }
        slope = 1.0 + 2.0 * h * d + k * B * force / (x - d);
        following = d - miss / slope;
        near = fabs(following - d) <= NEAR * (x - d);
        if (following <= low || following >= high) {
            following = 0.5 * (low + high);
            near = fabs(following - d) <= 1e-15 * x;
        }
        d = following;
        if (near) {
            break;
        }
    }
    return x - d;
}

/* effects.series_compliance.py: Return the tire's part [m] of a deflection above 0. */
static inline double series_compliance_pressed(double signal, Instant instant, Vector2 values)
{
    double step;
    double k = values.v[0], h = values.v[1];
    double A = instant.coefficient;
    double B = instant.exponent;
    double root = signal;
    double force = A * pow(100.0 * root, B);
    if (k * force > signal) {
        force = signal / k;
        root = 0.01 * pow(force / A, 1.0 / B);
    }
    if (B >= 1.0) {
        step = (root + k * force - signal) / (1.0 + k * B * force / root);
        while (step > NEAR * root) {
            root -= step;
            force = A * pow(100.0 * root, B);
            step = (root + k * force - signal) / (1.0 + k * B * force / root);
        }
        root -= step;
        return h > 0.0 ? series_compliance_stiffening(signal, k, h, A, B, root) : root;
    }
    step = (root + k * force - signal) / (k + root / (B * force));
    while (step > NEAR * force) {
        force -= step;
        root = 0.01 * pow(force / A, 1.0 / B);
        step = (root + k * force - signal) / (k + root / (B * force));
    }
    root = 0.01 * pow((force - step) / A, 1.0 / B);
    return h > 0.0 ? series_compliance_stiffening(signal, k, h, A, B, root) : root;
}

/* effects.series_compliance.py: Return the tire's part [m] of the deflection; that of a two-sided part is odd. */
static inline Tuple8 series_compliance_respond(double signal, Instant instant, Nothing state, Vector2 values)
{
    if (values.v[0] == 0.0 || (signal <= 0.0 && !(instant.two_sided && signal < 0.0))) {
        return (Tuple8){signal, state};
    }
    if (signal < 0.0) {
        return (Tuple8){-series_compliance_pressed(-signal, instant, values), state};
    }
    return (Tuple8){series_compliance_pressed(signal, instant, values), state};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_series(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[21] != 0.0) {
        const Tuple8 t1 = series_compliance_respond(signal, at, (Nothing){0}, (Vector2){{p[22], p[23]}});
        signal = t1.a;
    }
    return signal;
}

/* flat_step.py: Return the tire's deflection [m] for one that is read, and write the states of the effects before
   the law. */
static inline double compressed(Vector3 read, Tuple4 where, const double *p, const double *s, double *n)
{
    double deflection = read.v[0], rate = read.v[1], acceleration = read.v[2];
    double time = where.a;
    double interval = where.b;
    bool first = where.c;
    double pressure = where.d;
    double temperature = where.e;
    bool held = where.f;
    double A = where.g;
    double B = where.h;
    double bend = where.i;
    Instant at = (Instant){time, interval, first, deflection, rate, acceleration, A, B, 0.0, bend, pressure,
        temperature, held, 0.0};
    double x = through_deflection(deflection, at, p, s, n);
    at = (Instant){time, interval, first, x, rate, acceleration, A, B, 0.0, bend, pressure, temperature, held, 0.0};
    return through_series(x, at, p, s, n);
}

/* flat_step.py: Write a track into a state. */
static inline void store_compression(double *n, Tuple3 track)
{
    Vector14x4 modes = track.a;
    Vector4 probability = track.b;
    double last = track.c;
    for (int i = 0; i < 14; i++)
        n[122 + i] = modes.v[0].v[i];
    for (int i = 0; i < 14; i++)
        n[136 + i] = modes.v[1].v[i];
    for (int i = 0; i < 14; i++)
        n[150 + i] = modes.v[2].v[i];
    for (int i = 0; i < 14; i++)
        n[164 + i] = modes.v[3].v[i];
    for (int i = 0; i < 4; i++)
        n[178 + i] = probability.v[i];
    n[182] = last;
}

/* flat_step.py: Return the track after a reading of `deflection` [m], `interval` [s] after the last one; noise [m].
   */
static inline Tuple3 tracked_compression(const double *s, double deflection, double interval, double noise)
{
    if (s[4] == 0.0) {
        return tracking_begin(deflection);
    }
    Tuple3 before = (Tuple3){(Vector14x4){{*(const Vector14 *)(s + 122), *(const Vector14 *)(s + 136), *(const
        Vector14 *)(s + 150), *(const Vector14 *)(s + 164)}}, *(const Vector4 *)(s + 178), s[182]};
    if (interval > 0.0) {
        return tracking_follow(before, interval, deflection, noise);
    }
    return before;
}

/* power_law.py: Return the force [N] of a part that is held at both ends and pulls as it presses: A sign(x) |x|^B,
   x in cm. */
static inline double power_law_two_sided(double deflection, double coefficient, double exponent)
{
    if (deflection < 0.0) {
        return -tire_elastic(-deflection, coefficient, exponent);
    }
    return tire_elastic(deflection, coefficient, exponent);
}

/* effects.elastic_shape.py: Return 1 at the place of that number, 0 from the next ones on. */
static inline double elastic_shape_hat(double place, double number)
{
    return greater(1.0 - fabs(place - number), 0.0);
}

/* effects.elastic_shape.py: Multiply the force of the law by exp(c2 l^2 + c3 l^3 + h(x)). */
static inline Tuple8 elastic_shape_respond(double signal, Instant instant, Nothing state, Vector13 values)
{
    double log_ratio;
    double bend = values.v[0], twist = values.v[1], reference = values.v[2], h1 = values.v[3], h2 = values.v[4], h3
        = values.v[5], h4 = values.v[6], h5 = values.v[7], h6 = values.v[8], h7 = values.v[9], h8 = values.v[10], h9
        = values.v[11], h10 = values.v[12];
    double x = instant.two_sided ? fabs(instant.deflection) : instant.deflection;
    if (x <= 0.0 && !instant.two_sided) {
        return (Tuple8){signal, state};
    }
    double exponent = 0.0;
    if (bend != 0.0 || twist != 0.0) {
        log_ratio = log(lesser(greater(x / reference, 0.01), 100.0));
        exponent = log_ratio * log_ratio * (bend + twist * log_ratio);
    }
    double place = lesser(greater(5.0 * x / reference, 1.0), 10.0);
    exponent += h1 * elastic_shape_hat(place, 1.0) + h2 * elastic_shape_hat(place, 2.0) + h3 *
        elastic_shape_hat(place, 3.0) + h4 * elastic_shape_hat(place, 4.0);
    exponent += h5 * elastic_shape_hat(place, 5.0) + h6 * elastic_shape_hat(place, 6.0) + h7 *
        elastic_shape_hat(place, 7.0) + h8 * elastic_shape_hat(place, 8.0);
    exponent += h9 * elastic_shape_hat(place, 9.0) + h10 * elastic_shape_hat(place, 10.0);
    return (Tuple8){signal * exp(exponent), state};
}

/* effects.part_shape.py: Return the cubic B-spline b of unit spacing at a distance from its middle: 2/3 there, 0
   from 2 on. */
static inline double part_shape_bump(double distance)
{
    double far = greater(2.0 - fabs(distance), 0.0);
    double near = greater(1.0 - fabs(distance), 0.0);
    return (far * far * far - 4.0 * near * near * near) / 6.0;
}

/* effects.part_shape.py: Return g(x) [N] at a deflection [m]. */
static inline double part_shape_curve(double x, Vector12 values)
{
    double lowest = values.v[0], highest = values.v[1], g1 = values.v[2], g2 = values.v[3], g3 = values.v[4], g4 =
        values.v[5], g5 = values.v[6], g6 = values.v[7], g7 = values.v[8], g8 = values.v[9], g9 = values.v[10], g10
        = values.v[11];
    double place = 2.0 + lesser(greater(7.0 * (x - lowest) / greater(highest - lowest, 1e-300), 0.0), 7.0);
    double force = g1 * part_shape_bump(place - 1.0) + g2 * part_shape_bump(place - 2.0) + g3 *
        part_shape_bump(place - 3.0) + g4 * part_shape_bump(place - 4.0);
    force += g5 * part_shape_bump(place - 5.0) + g6 * part_shape_bump(place - 6.0) + g7 * part_shape_bump(place -
        7.0) + g8 * part_shape_bump(place - 8.0);
    return force + g9 * part_shape_bump(place - 9.0) + g10 * part_shape_bump(place - 10.0);
}

/* effects.part_shape.py: Add g(x) - g(0) to the elastic force [N]. */
static inline Tuple8 part_shape_respond(double signal, Instant instant, Nothing state, Vector12 values)
{
    if (instant.deflection <= 0.0 && !instant.two_sided) {
        return (Tuple8){signal, state};
    }
    return (Tuple8){signal + (part_shape_curve(instant.deflection, values) - part_shape_curve(0.0, values)), state};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_law(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[24] != 0.0) {
        const Tuple8 t1 = elastic_shape_respond(signal, at, (Nothing){0}, *(const Vector13 *)(p + 25));
        signal = t1.a;
    }
    if (p[38] != 0.0) {
        const Tuple8 t2 = part_shape_respond(signal, at, (Nothing){0}, *(const Vector12 *)(p + 39));
        signal = t2.a;
    }
    return signal;
}

/* effect.py: Return whether a channel was recorded: NOT_MEASURED is not equal to itself. */
static inline bool effect_is_measured(double value)
{
    return value == value;
}

/* effects.inflation_pressure.py: Multiply the factor by the share of the casing and that of the air at this
   pressure. */
static inline Tuple8 inflation_pressure_respond(double signal, Instant instant, Nothing state, Vector3 values)
{
    double gain = values.v[0], reference = values.v[1], power = values.v[2];
    if (!effect_is_measured(instant.pressure)) {
        return (Tuple8){signal, state};
    }
    double ratio = greater(instant.pressure / reference, 0.0);
    if (power != 1.0) {
        ratio = pow(ratio, power);
    }
    return (Tuple8){signal * (1.0 + gain * (ratio - 1.0)), state};
}

/* effects.gas_compression.py: Multiply the factor by p / p0. */
static inline Tuple8 gas_compression_respond(double signal, Instant instant, Nothing state, Vector5 values)
{
    double share = values.v[0], power = values.v[1], polytropic = values.v[2], surface = values.v[3], atmosphere =
        values.v[4];
    if (share == 0.0 || instant.deflection <= 0.0) {
        return (Tuple8){signal, state};
    }
    if (surface != 0.0) {
        share *= pow(greater(1.0 + WHEEL_RADIUS * instant.curvature, LEAST_CURVATURE), -surface);
    }
    double lost = lesser(share * pow(instant.deflection / REFERENCE, power), LOST_MAX);
    return (Tuple8){signal * ((1.0 + atmosphere) * pow(1.0 - lost, -polytropic) - atmosphere), state};
}

/* effects.mullins_softening.py: Multiply the factor by the softening; the state: largest measure, last counted
   position [m], path length [m]. */
static inline Tuple15 mullins_softening_respond(double signal, Instant instant, Vector3 state, Vector7 values)
{
    double share = values.v[0], ratio = values.v[1], width = values.v[2], gaussian = values.v[3], history =
        values.v[4], gathering = values.v[5], load = values.v[6];
    double x = instant.two_sided ? fabs(instant.deflection) : instant.deflection;
    double largest = state.v[0], counted = state.v[1], path = state.v[2];
    double power = 1.0 + load * instant.exponent;
    double by_surface = pow(instant.coefficient, load);
    if (instant.first) {
        largest = by_surface * pow(100.0 * history, power);
        counted = greater(x, 0.0);
    }
    double measure = by_surface * pow(100.0 * greater(x, 0.0), power);
    double uncounted = fabs(greater(x, 0.0) - counted);
    if (measure >= largest) {
        largest = measure;
        counted = greater(x, 0.0);
        uncounted = 0.0;
    } else if (uncounted > DEAD_PART * gathering) {
        path = path + uncounted;
        counted = greater(x, 0.0);
        uncounted = 0.0;
    }
    if (share == 0.0 || (x <= 0.0 && !instant.two_sided) || measure >= largest) {
        return (Tuple15){signal, (Vector3){{largest, counted, path}}};
    }
    double fixed = by_surface * pow(100.0 * width, power);
    if (!instant.two_sided) {
        fixed = pow(FLAT_COEFFICIENT, load) * pow(100.0 * width, 1.0 + load * FLAT_EXPONENT);
    }
    double below = (largest - measure) / (ratio * largest + fixed);
    below += gaussian * below * below;
    if (gathering > 0.0) {
        share *= -expm1(-(path + uncounted) / gathering);
    }
    return (Tuple15){signal * (1.0 + share * expm1(-below)), (Vector3){{largest, counted, path}}};
}

/* effects.pressure_leak.py: Multiply the factor by the remaining pressure. */
static inline Tuple8 pressure_leak_respond(double signal, Instant instant, Nothing state, Vector3 values)
{
    double rate = values.v[0], structural = values.v[1], flow = values.v[2];
    double lost = rate * instant.time;
    double slowing = (flow - 1.0) * lost;
    if (slowing <= -1.0) {
        return (Tuple8){signal * structural, state};
    }
    if (fabs(slowing) > 1e-09) {
        lost *= log1p(slowing) / slowing;
    }
    return (Tuple8){signal * (1.0 + (1.0 - structural) * expm1(-lost)), state};
}

/* effects.warm_up.py: Multiply the factor by the rise of the pressure; the state is the first measured temperature
   [K], 0 before it. */
static inline Tuple11 warm_up_respond(double signal, Instant instant, Vector1 state, Vector3 values)
{
    double start;
    double gain = values.v[0], tau = values.v[1], stretch = values.v[2];
    if (effect_is_measured(instant.temperature)) {
        start = state.v[0] > 0.0 ? state.v[0] : instant.temperature;
        return (Tuple11){signal * greater(1.0 + gain * (instant.temperature - start) / WARMING, 0.0),
            (Vector1){{start}}};
    }
    return (Tuple11){signal * (1.0 - gain * expm1(-pow(instant.time / tau, stretch))), state};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_scale(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[51] != 0.0) {
        const Tuple8 t1 = inflation_pressure_respond(signal, at, (Nothing){0}, (Vector3){{p[52], p[53], p[54]}});
        signal = t1.a;
    }
    if (p[55] != 0.0) {
        const Tuple8 t2 = gas_compression_respond(signal, at, (Nothing){0}, *(const Vector5 *)(p + 56));
        signal = t2.a;
    }
    if (p[61] != 0.0) {
        const Tuple15 t3 = mullins_softening_respond(signal, at, (Vector3){{s[7], s[8], s[9]}}, *(const Vector7 *)(p
            + 62));
        signal = t3.a;
        Vector3 after = t3.b;
        n[7] = after.v[0];
        n[8] = after.v[1];
        n[9] = after.v[2];
    }
    if (p[69] != 0.0) {
        const Tuple8 t4 = pressure_leak_respond(signal, at, (Nothing){0}, (Vector3){{p[70], p[71], p[72]}});
        signal = t4.a;
    }
    if (p[73] != 0.0) {
        const Tuple11 t5 = warm_up_respond(signal, at, (Vector1){{s[10]}}, (Vector3){{p[74], p[75], p[76]}});
        signal = t5.a;
        Vector1 after = t5.b;
        n[10] = after.v[0];
    }
    return signal;
}

/* effects.rate_independent_hysteresis.py: Return z after `travel` [m] in one direction. */
static inline double rate_independent_hysteresis_dahl(double z, double travel, double reach)
{
    if (travel > 0.0) {
        return z - (1.0 - z) * expm1(-travel / reach);
    }
    if (travel < 0.0) {
        return z + (1.0 + z) * expm1(travel / reach);
    }
    return z;
}

/* effects.rate_independent_hysteresis.py: Return y after `travel` [m] of an element that slips at `reach` [m]. */
static inline double rate_independent_hysteresis_slip(double y, double travel, double reach)
{
    return lesser(greater(y + travel / reach, -1.0), 1.0);
}

/* effects.rate_independent_hysteresis.py: Add the friction force [N]. */
static inline Tuple18 rate_independent_hysteresis_respond(double signal, Instant instant, Vector8 state, Vector8
    values)
{
    double friction;
    double mean;
    double slip_force = values.v[0], load_share = values.v[1], reach = values.v[2], memory = values.v[3], spread =
        values.v[4], play = values.v[5], seat = values.v[6], rebound = values.v[7];
    double z = state.v[0], updated_at = state.v[1], direction = state.v[2], last = state.v[3], y1 = state.v[4], y2 =
        state.v[5], y3 = state.v[6], y4 = state.v[7];
    double x = instant.two_sided ? instant.deflection : greater(instant.deflection, 0.0);
    if (instant.first) {
        last = 0.0;
        updated_at = 0.0;
    }
    double travel = x - updated_at;
    if (instant.first || travel * direction > 0.0 || fabs(travel) >= 2.0 * play) {
        const double t1 = rate_independent_hysteresis_dahl(z, travel, reach) * (instant.first ? seat : 1.0);
        friction = t1;
        z = t1;
        updated_at = x;
        direction = travel >= 0.0 ? 1.0 : -1.0;
    } else {
        friction = rate_independent_hysteresis_dahl(z, travel * fabs(travel) / (2.0 * play), reach);
    }
    if (memory != 0.0) {
        travel = x - last;
        mean = reach * 4.0 / 3.0;
        y1 = rate_independent_hysteresis_slip(y1, travel, mean * (1.0 - 0.75 * spread));
        y2 = rate_independent_hysteresis_slip(y2, travel, mean * (1.0 - 0.25 * spread));
        y3 = rate_independent_hysteresis_slip(y3, travel, mean * (1.0 + 0.25 * spread));
        y4 = rate_independent_hysteresis_slip(y4, travel, mean * (1.0 + 0.75 * spread));
        if (instant.first) {
            y1 = seat * y1;
            y2 = seat * y2;
            y3 = seat * y3;
            y4 = seat * y4;
        }
        friction += memory * (0.25 * (y1 + y2 + y3 + y4) - friction);
    }
    Vector8 after = (Vector8){{z, updated_at, direction, x, y1, y2, y3, y4}};
    if (instant.deflection <= 0.0 && !instant.two_sided) {
        return (Tuple18){signal, after};
    }
    if (friction < 0.0) {
        friction *= rebound;
    }
    return (Tuple18){signal + (slip_force + load_share * fabs(instant.elastic_force)) * friction, after};
}

/* effects.viscous_damping.py: Return the dashpot's force [N] at the rate v0 on the way in (side 1) or back (-1). */
static inline double viscous_damping_size_of(double side, double deflection, Vector7 values)
{
    double damping = values.v[0], deflection_exponent = values.v[2], rebound = values.v[4];
    double size = damping * SPEED;
    if (deflection_exponent != 0.0) {
        size *= pow(fabs(deflection) / DEPTH, deflection_exponent);
    }
    return side > 0.0 ? size : size * rebound;
}

/* effects.viscous_damping.py: Return the dashpot's force [N] at a rate [m/s], both above 0; size [N]: at the rate
   v0. */
static inline double viscous_damping_force_at(double rate, double size, double exponent, double thinning)
{
    if (thinning > 0.0) {
        rate = asinh(thinning * rate) / thinning;
    }
    double force = size * pow(rate / SPEED, exponent);
    return force;
}

/* effects.viscous_damping.py: Return the force [N] at a constant rate [m/s], and by how much the mounts give way
   [m]. */
static inline Vector2 viscous_damping_steady(double rate, double deflection, Vector7 values)
{
    if (rate == 0.0) {
        return (Vector2){{0.0, 0.0}};
    }
    double side = rate > 0.0 ? 1.0 : -1.0;
    double force = viscous_damping_force_at(fabs(rate), viscous_damping_size_of(side, deflection, values),
        values.v[1], values.v[3]);
    return (Vector2){{side * force, side * (0.5 * values.v[6] + values.v[5] * force)}};
}

/* effects.viscous_damping.py: Return the dashpot's rate [m/s] at a force [N] above 0, and its derivatives [m/s/N],
   [m/s/N^2]. */
static inline Vector3 viscous_damping_rate_at(double force, double size, double exponent, double thinning)
{
    double turned;
    double steeper;
    double rate = SPEED * pow(force / size, 1.0 / exponent);
    double slope = rate / (exponent * force);
    double bend = slope * (1.0 / exponent - 1.0) / force;
    if (thinning > 0.0) {
        turned = sinh(lesser(thinning * rate, STEEPEST));
        steeper = sqrt(1.0 + turned * turned);
        return (Vector3){{turned / thinning, slope * steeper, bend * steeper + thinning * slope * slope * turned}};
    }
    return (Vector3){{rate, slope, bend}};
}

/* effects.viscous_damping.py: Add the dashpot's force [N] for a solver: the state is by how much compliance and
   play give way. */
static inline Tuple11 viscous_damping_flow(double signal, Instant instant, Vector1 state, Vector7 values)
{
    double compliance = values.v[5];
    double half = 0.5 * values.v[6];
    double x = instant.deflection;
    double v = instant.rate;
    if (x <= 0.0 && !instant.two_sided) {
        return (Tuple11){signal, (Vector1){{instant.first ? 0.0 : -state.v[0] / RELEASED}}};
    }
    const Vector2 t1 = viscous_damping_steady(v, x, values);
    double force = t1.v[0], given_way = t1.v[1];
    if (instant.first) {
        return (Tuple11){signal + force, (Vector1){{given_way}}};
    }
    if (compliance <= 0.0 && half <= 0.0) {
        return (Tuple11){signal + force, (Vector1){{0.0}}};
    }
    double z = state.v[0];
    double side = z > 0.0 ? 1.0 : -1.0;
    double beyond = fabs(z) - half;
    if (compliance <= 0.0) {
        if (beyond >= 0.0 && v * side > 0.0) {
            return (Tuple11){signal + force, (Vector1){{0.0}}};
        }
        return (Tuple11){signal, (Vector1){{v}}};
    }
    if (beyond <= 0.0) {
        return (Tuple11){signal, (Vector1){{v}}};
    }
    double size = viscous_damping_size_of(side, x, values);
    if (size <= 0.0) {
        return (Tuple11){signal, (Vector1){{v - side * beyond / RELEASED}}};
    }
    const Vector3 t2 = viscous_damping_rate_at(beyond / compliance, size, values.v[1], values.v[3]);
    double rate = t2.v[0];
    return (Tuple11){signal + side * beyond / compliance, (Vector1){{v - side * rate}}};
}

/* effects.viscous_damping.py: Return the force D [N] with e D + h v_d(D) = reach [m], h the interval [s]: by
   Halley's method in a bracket. */
static inline double viscous_damping_carried(double reach, double interval, double start, double compliance, Vector3
    dashpot)
{
    double rate;
    double slope;
    double bend;
    double miss;
    double steep;
    double turn;
    double following;
    bool near;
    double size = dashpot.v[0], exponent = dashpot.v[1], thinning = dashpot.v[2];
    if (compliance <= 0.0) {
        return viscous_damping_force_at(reach / interval, size, exponent, thinning);
    }
    if (exponent == 1.0 && thinning == 0.0) {
        return reach / (compliance + interval * SPEED / size);
    }
    double high = lesser(viscous_damping_force_at(reach / interval, size, exponent, thinning), reach / compliance);
    double low = 0.0;
    double force = start > 0.0 && start < high ? start : high;
    for (int t1 = 0; t1 < 60; t1++) {
        if (force <= 0.0) {
            break;
        }
        const Vector3 t2 = viscous_damping_rate_at(force, size, exponent, thinning);
        rate = t2.v[0];
        slope = t2.v[1];
        bend = t2.v[2];
        miss = compliance * force + interval * rate - reach;
        if (miss > 0.0) {
            high = force;
        } else {
            low = force;
        }
        steep = compliance + interval * slope;
        turn = steep * steep - 0.5 * miss * interval * bend;
        following = turn > 0.0 ? force - miss * steep / turn : force - miss / steep;
        near = fabs(following - force) <= VISCOUS_DAMPING_NEAR * force;
        if (following < low || following > high) {
            following = 0.5 * (low + high);
            near = high - low <= 1e-15 * high;
        }
        force = following;
        if (near) {
            break;
        }
    }
    return force;
}

/* effects.viscous_damping.py: Return the force [N] behind compliance and play after a step, and by how much they
   give way [m]. */
static inline Vector2 viscous_damping_in_series(Instant instant, double given_way, Vector7 values)
{
    double x = instant.deflection;
    double v = instant.rate;
    double compliance = values.v[5];
    double half = 0.5 * values.v[6];
    double reach = given_way + v * instant.interval;
    double side = reach > 0.0 ? 1.0 : -1.0;
    double beyond = fabs(reach) - half;
    if (beyond <= 0.0) {
        return (Vector2){{0.0, reach}};
    }
    if (instant.interval <= 0.0) {
        return (Vector2){{compliance > 0.0 ? side * beyond / compliance : 0.0, reach}};
    }
    double size = viscous_damping_size_of(side, x, values);
    if (size <= 0.0) {
        return (Vector2){{0.0, side * half}};
    }
    double before = compliance > 0.0 ? (side * given_way - half) / compliance : 0.0;
    double force = viscous_damping_carried(beyond, instant.interval, before, compliance, (Vector3){{size,
        values.v[1], values.v[3]}});
    return (Vector2){{side * force, side * (half + compliance * force)}};
}

/* effects.viscous_damping.py: Add the dashpot's force [N] while the tire is loaded; a part that is held at both
   ends always is. */
static inline Tuple11 viscous_damping_respond(double signal, Instant instant, Vector1 state, Vector7 values)
{
    double force;
    double given_way;
    double size;
    double damping = values.v[0], rate_exponent = values.v[1], deflection_exponent = values.v[2], thinning =
        values.v[3], rebound = values.v[4], compliance = values.v[5], play = values.v[6];
    double x = instant.deflection;
    double v = instant.rate;
    if (x <= 0.0 && !instant.two_sided) {
        return (Tuple11){signal, (Vector1){{0.0}}};
    }
    if (compliance > 0.0 || play > 0.0) {
        if (instant.first) {
            const Vector2 t1 = viscous_damping_steady(v, x, values);
            force = t1.v[0];
            given_way = t1.v[1];
        } else {
            const Vector2 t2 = viscous_damping_in_series(instant, state.v[0], values);
            force = t2.v[0];
            given_way = t2.v[1];
        }
        return (Tuple11){signal + force, (Vector1){{given_way}}};
    }
    if (thinning > 0.0) {
        v = asinh(thinning * v) / thinning;
    }
    if (rate_exponent != 1.0) {
        size = SPEED * pow(fabs(v) / SPEED, rate_exponent);
        v = v > 0.0 ? size : -size;
    }
    if (deflection_exponent != 0.0) {
        v *= pow(fabs(x) / DEPTH, deflection_exponent);
    }
    if (v < 0.0) {
        v *= rebound;
    }
    return (Tuple11){signal + damping * v, (Vector1){{0.0}}};
}

/* effects.viscoelastic_relaxation.py: Return t0 [s] for a freshness above 0 and the first relaxation time [s]. */
static inline double viscoelastic_relaxation_time_held(double freshness, double tau)
{
    return tau * (1.0 / freshness - 1.0);
}

/* effects.viscoelastic_relaxation.py: Return h [N] of an elastic force [N] that was reached at once and held for a
   time [s]. */
static inline double viscoelastic_relaxation_left(double elastic, double held, double tau)
{
    return elastic * exp(-held / tau);
}

/* effects.viscoelastic_relaxation.py: Add the overstress [N] with q_i = F_elastic - h_i for a solver: dq_i/dt =
   (F_elastic - q_i) / tau_i. */
static inline Tuple20 viscoelastic_relaxation_flow(double signal, Instant instant, Vector6 state, Vector12 values)
{
    double held;
    double g1 = values.v[0], tau1 = values.v[1], g2 = values.v[2], tau2 = values.v[3], g3 = values.v[4], tau3 =
        values.v[5], sudden = values.v[6], g4 = values.v[7], tau4 = values.v[8], g5 = values.v[9], tau5 =
        values.v[10], freshness = values.v[11];
    double elastic = instant.elastic_force - instant.preload;
    double q1 = state.v[1], q2 = state.v[2], q3 = state.v[3], q4 = state.v[4], q5 = state.v[5];
    if (instant.first) {
        q1 = elastic;
        q2 = elastic;
        q3 = elastic;
        q4 = elastic;
        q5 = elastic;
        if (freshness > 0.0) {
            held = viscoelastic_relaxation_time_held(freshness, tau1);
            q1 = q1 - viscoelastic_relaxation_left(elastic, held, tau1);
            q2 = q2 - viscoelastic_relaxation_left(elastic, held, tau2);
            q3 = q3 - viscoelastic_relaxation_left(elastic, held, tau3);
            q4 = q4 - viscoelastic_relaxation_left(elastic, held, tau4);
            q5 = q5 - viscoelastic_relaxation_left(elastic, held, tau5);
        }
    }
    double h1 = elastic - q1;
    double h2 = elastic - q2;
    double h3 = elastic - q3;
    double h4 = elastic - q4;
    double h5 = elastic - q5;
    double added = g1 * h1 + g2 * h2 + g3 * h3 + g4 * h4 + g5 * h5 - sudden * (g1 + g2 + g3 + g4 + g5) * elastic;
    if (instant.first) {
        return (Tuple20){signal + added, (Vector6){{0.0, q1, q2, q3, q4, q5}}};
    }
    return (Tuple20){signal + added, (Vector6){{0.0, h1 / tau1, h2 / tau2, h3 / tau3, h4 / tau4, h5 / tau5}}};
}

/* effects.viscoelastic_relaxation.py: Return h after `interval` [s] in which the elastic force changed linearly by
   `change` [N]. */
static inline double viscoelastic_relaxation_overstress(double h, double change, double interval, double tau)
{
    double passed = interval / tau;
    if (passed == 0.0) {
        return h + change;
    }
    double decay = -expm1(-passed);
    return h * (1.0 - decay) + change * decay / passed;
}

/* effects.viscoelastic_relaxation.py: Add the overstress [N]; the state holds the last elastic force and the five
   overstresses. */
static inline Tuple20 viscoelastic_relaxation_respond(double signal, Instant instant, Vector6 state, Vector12
    values)
{
    double held;
    double g1 = values.v[0], tau1 = values.v[1], g2 = values.v[2], tau2 = values.v[3], g3 = values.v[4], tau3 =
        values.v[5], sudden = values.v[6], g4 = values.v[7], tau4 = values.v[8], g5 = values.v[9], tau5 =
        values.v[10], freshness = values.v[11];
    double elastic = instant.elastic_force - instant.preload;
    double last = state.v[0], h1 = state.v[1], h2 = state.v[2], h3 = state.v[3], h4 = state.v[4], h5 = state.v[5];
    if (instant.first) {
        last = elastic;
        if (freshness > 0.0) {
            held = viscoelastic_relaxation_time_held(freshness, tau1);
            h1 = viscoelastic_relaxation_left(elastic, held, tau1);
            h2 = viscoelastic_relaxation_left(elastic, held, tau2);
            h3 = viscoelastic_relaxation_left(elastic, held, tau3);
            h4 = viscoelastic_relaxation_left(elastic, held, tau4);
            h5 = viscoelastic_relaxation_left(elastic, held, tau5);
        }
    }
    double change = elastic - last;
    h1 = viscoelastic_relaxation_overstress(h1, change, instant.interval, tau1);
    if (g2 != 0.0) {
        h2 = viscoelastic_relaxation_overstress(h2, change, instant.interval, tau2);
    }
    if (g3 != 0.0) {
        h3 = viscoelastic_relaxation_overstress(h3, change, instant.interval, tau3);
    }
    if (g4 != 0.0) {
        h4 = viscoelastic_relaxation_overstress(h4, change, instant.interval, tau4);
    }
    if (g5 != 0.0) {
        h5 = viscoelastic_relaxation_overstress(h5, change, instant.interval, tau5);
    }
    double added = g1 * h1 + g2 * h2 + g3 * h3 + g4 * h4 + g5 * h5;
    if (sudden != 0.0) {
        added -= sudden * (g1 + g2 + g3 + g4 + g5) * elastic;
    }
    return (Tuple20){signal + added, (Vector6){{elastic, h1, h2, h3, h4, h5}}};
}

/* effects.bottoming.py: Add the second spring's force [N]. */
static inline Tuple8 bottoming_respond(double signal, Instant instant, Nothing state, Vector4 values)
{
    double stiffness = values.v[0], onset = values.v[1], softness = values.v[2], power = values.v[3];
    double beyond = instant.deflection - onset;
    bool in_air = instant.deflection <= 0.0 && !instant.two_sided;
    if (stiffness == 0.0 || in_air || beyond <= -FAR * softness) {
        return (Tuple8){signal, state};
    }
    if (beyond < FAR * softness) {
        beyond = softness * log1p(exp(beyond / softness));
    }
    if (power != 1.0) {
        beyond = UNIT * pow(beyond / UNIT, power);
    }
    return (Tuple8){signal + stiffness * beyond, state};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_parallel(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[77] != 0.0) {
        const Tuple18 t1 = rate_independent_hysteresis_respond(signal, at, *(const Vector8 *)(s + 11), *(const
            Vector8 *)(p + 78));
        signal = t1.a;
        Vector8 after = t1.b;
        for (int i = 0; i < 8; i++)
            n[11 + i] = after.v[i];
    }
    if (p[86] != 0.0 && p[3] != 0.0) {
        const Tuple11 t2 = viscous_damping_flow(signal, at, (Vector1){{s[19]}}, *(const Vector7 *)(p + 87));
        signal = t2.a;
        Vector1 flowed = t2.b;
        n[19] = flowed.v[0];
    } else if (p[86] != 0.0) {
        const Tuple11 t3 = viscous_damping_respond(signal, at, (Vector1){{s[19]}}, *(const Vector7 *)(p + 87));
        signal = t3.a;
        Vector1 after = t3.b;
        n[19] = after.v[0];
    }
    if (p[94] != 0.0 && p[3] != 0.0) {
        const Tuple20 t4 = viscoelastic_relaxation_flow(signal, at, *(const Vector6 *)(s + 20), *(const Vector12
            *)(p + 95));
        signal = t4.a;
        Vector6 flowed = t4.b;
        for (int i = 0; i < 6; i++)
            n[20 + i] = flowed.v[i];
    } else if (p[94] != 0.0) {
        const Tuple20 t5 = viscoelastic_relaxation_respond(signal, at, *(const Vector6 *)(s + 20), *(const Vector12
            *)(p + 95));
        signal = t5.a;
        Vector6 after = t5.b;
        for (int i = 0; i < 6; i++)
            n[20 + i] = after.v[i];
    }
    if (p[107] != 0.0) {
        const Tuple8 t6 = bottoming_respond(signal, at, (Nothing){0}, *(const Vector4 *)(p + 108));
        signal = t6.a;
    }
    return signal;
}

/* effects.inertia.py: Add m d2x/dt2 [N]. */
static inline Tuple8 inertia_respond(double signal, Instant instant, Nothing state, Vector1 values)
{
    return (Tuple8){signal + values.v[0] * instant.acceleration, state};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_mass(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[112] != 0.0) {
        const Tuple8 t1 = inertia_respond(signal, at, (Nothing){0}, (Vector1){{p[113]}});
        signal = t1.a;
    }
    return signal;
}

/* effects.force_lag.py: Return the force [N] a delay `delta` [s] ago and the stored samples after this one: times,
   then forces. */
static inline Tuple23 force_lag_delayed(double signal, Instant instant, Vector35 state, double delta)
{
    Vector2 two;
    Vector4 four;
    double part;
    Vector16 times = (Vector16){{state.v[3], state.v[4], state.v[5], state.v[6], state.v[7], state.v[8], state.v[9],
        state.v[10], state.v[11], state.v[12], state.v[13], state.v[14], state.v[15], state.v[16], state.v[17],
        state.v[18]}};
    Vector16 forces = (Vector16){{state.v[19], state.v[20], state.v[21], state.v[22], state.v[23], state.v[24],
        state.v[25], state.v[26], state.v[27], state.v[28], state.v[29], state.v[30], state.v[31], state.v[32],
        state.v[33], state.v[34]}};
    double now = instant.time;
    Vector1 newest = (Vector1){{now}};
    Vector1 force = (Vector1){{signal}};
    if (instant.first) {
        two = (Vector2){{force.v[0], force.v[0]}};
        four = (Vector4){{two.v[0], two.v[1], two.v[0], two.v[1]}};
        forces = (Vector16){{four.v[0], four.v[1], four.v[2], four.v[3], four.v[0], four.v[1], four.v[2], four.v[3],
            four.v[0], four.v[1], four.v[2], four.v[3], four.v[0], four.v[1], four.v[2], four.v[3]}};
    } else if (instant.interval <= 0.0 || times.v[15] - times.v[14] < delta / 14.0) {
        times = (Vector16){{times.v[0], times.v[1], times.v[2], times.v[3], times.v[4], times.v[5], times.v[6],
            times.v[7], times.v[8], times.v[9], times.v[10], times.v[11], times.v[12], times.v[13], times.v[14],
            newest.v[0]}};
        forces = (Vector16){{forces.v[0], forces.v[1], forces.v[2], forces.v[3], forces.v[4], forces.v[5],
            forces.v[6], forces.v[7], forces.v[8], forces.v[9], forces.v[10], forces.v[11], forces.v[12],
            forces.v[13], forces.v[14], force.v[0]}};
    } else {
        times = (Vector16){{times.v[1], times.v[2], times.v[3], times.v[4], times.v[5], times.v[6], times.v[7],
            times.v[8], times.v[9], times.v[10], times.v[11], times.v[12], times.v[13], times.v[14], times.v[15],
            newest.v[0]}};
        forces = (Vector16){{forces.v[1], forces.v[2], forces.v[3], forces.v[4], forces.v[5], forces.v[6],
            forces.v[7], forces.v[8], forces.v[9], forces.v[10], forces.v[11], forces.v[12], forces.v[13],
            forces.v[14], forces.v[15], force.v[0]}};
    }
    double late = signal;
    if (delta > 0.0) {
        late = forces.v[0];
        for (int i = 15; i > 0; i--) {
            if (times.v[i - 1] < now - delta) {
                part = (now - delta - times.v[i - 1]) / (times.v[i] - times.v[i - 1]);
                late = forces.v[i - 1] + part * (forces.v[i] - forces.v[i - 1]);
                break;
            }
        }
    }
    return (Tuple23){late, (Vector32){{times.v[0], times.v[1], times.v[2], times.v[3], times.v[4], times.v[5],
        times.v[6], times.v[7], times.v[8], times.v[9], times.v[10], times.v[11], times.v[12], times.v[13],
        times.v[14], times.v[15], forces.v[0], forces.v[1], forces.v[2], forces.v[3], forces.v[4], forces.v[5],
        forces.v[6], forces.v[7], forces.v[8], forces.v[9], forces.v[10], forces.v[11], forces.v[12], forces.v[13],
        forces.v[14], forces.v[15]}}};
}

/* effects.force_lag.py: Return the measured force [N] for a solver: the states are the output and its slope; the
   delay is memory. */
static inline Tuple25 force_lag_flow(double signal, Instant instant, Vector35 state, Vector3 values)
{
    Vector3 held;
    double tau = values.v[0], delta = values.v[1], quality = values.v[2];
    double reading = state.v[0];
    double slope = state.v[1];
    const Tuple23 t1 = force_lag_delayed(signal, instant, state, delta);
    double late = t1.a;
    Vector32 samples = t1.b;
    if (instant.first) {
        held = (Vector3){{late, 0.0, late}};
        return (Tuple25){late, (Vector35){{held.v[0], held.v[1], held.v[2], samples.v[0], samples.v[1],
            samples.v[2], samples.v[3], samples.v[4], samples.v[5], samples.v[6], samples.v[7], samples.v[8],
            samples.v[9], samples.v[10], samples.v[11], samples.v[12], samples.v[13], samples.v[14], samples.v[15],
            samples.v[16], samples.v[17], samples.v[18], samples.v[19], samples.v[20], samples.v[21], samples.v[22],
            samples.v[23], samples.v[24], samples.v[25], samples.v[26], samples.v[27], samples.v[28], samples.v[29],
            samples.v[30], samples.v[31]}}};
    }
    if (tau == 0.0) {
        held = (Vector3){{0.0, 0.0, late}};
        return (Tuple25){late, (Vector35){{held.v[0], held.v[1], held.v[2], samples.v[0], samples.v[1],
            samples.v[2], samples.v[3], samples.v[4], samples.v[5], samples.v[6], samples.v[7], samples.v[8],
            samples.v[9], samples.v[10], samples.v[11], samples.v[12], samples.v[13], samples.v[14], samples.v[15],
            samples.v[16], samples.v[17], samples.v[18], samples.v[19], samples.v[20], samples.v[21], samples.v[22],
            samples.v[23], samples.v[24], samples.v[25], samples.v[26], samples.v[27], samples.v[28], samples.v[29],
            samples.v[30], samples.v[31]}}};
    }
    if (quality * tau < NO_TIME) {
        held = (Vector3){{(late - reading) / tau, 0.0, late}};
        return (Tuple25){reading, (Vector35){{held.v[0], held.v[1], held.v[2], samples.v[0], samples.v[1],
            samples.v[2], samples.v[3], samples.v[4], samples.v[5], samples.v[6], samples.v[7], samples.v[8],
            samples.v[9], samples.v[10], samples.v[11], samples.v[12], samples.v[13], samples.v[14], samples.v[15],
            samples.v[16], samples.v[17], samples.v[18], samples.v[19], samples.v[20], samples.v[21], samples.v[22],
            samples.v[23], samples.v[24], samples.v[25], samples.v[26], samples.v[27], samples.v[28], samples.v[29],
            samples.v[30], samples.v[31]}}};
    }
    held = (Vector3){{slope, (late - reading - tau * slope) / pow(quality * tau, 2.0), late}};
    return (Tuple25){reading, (Vector35){{held.v[0], held.v[1], held.v[2], samples.v[0], samples.v[1], samples.v[2],
        samples.v[3], samples.v[4], samples.v[5], samples.v[6], samples.v[7], samples.v[8], samples.v[9],
        samples.v[10], samples.v[11], samples.v[12], samples.v[13], samples.v[14], samples.v[15], samples.v[16],
        samples.v[17], samples.v[18], samples.v[19], samples.v[20], samples.v[21], samples.v[22], samples.v[23],
        samples.v[24], samples.v[25], samples.v[26], samples.v[27], samples.v[28], samples.v[29], samples.v[30],
        samples.v[31]}}};
}

/* effects.force_lag.py: Return output [N] and slope [N/s] after an interval [s] over which the input changes
   linearly to `late` [N]. */
static inline Vector2 force_lag_low_passed(Vector3 before, double late, double interval, double tau, double quality)
{
    double width;
    double quick;
    double slow;
    double long_;
    double short_;
    double phase_squared;
    double cosine;
    double sine;
    double fall;
    double spring;
    double reading = before.v[0], slope = before.v[1], last = before.v[2];
    double rate = (late - last) / interval;
    double off = reading - last + tau * rate;
    double off_slope = slope - rate;
    if (quality * tau < NO_TIME) {
        return (Vector2){{late - tau * rate + off * exp(-interval / tau), 0.0}};
    }
    double square = pow(quality * tau, 2.0);
    double damping = 0.5 * tau / square;
    double beyond = damping * damping - 1.0 / square;
    double drive = off_slope + damping * off;
    if (beyond * interval * interval > NEARLY_CRITICAL) {
        width = sqrt(beyond);
        quick = damping + width;
        slow = 1.0 / (square * quick);
        long_ = 0.5 * (off + drive / width) * exp(-slow * interval);
        short_ = 0.5 * (off - drive / width) * exp(-quick * interval);
        off = long_ + short_;
        off_slope = -slow * long_ - quick * short_;
    } else {
        phase_squared = beyond * interval * interval;
        cosine = 1.0 + phase_squared / 2.0;
        sine = interval * (1.0 + phase_squared / 6.0);
        if (phase_squared < -NEARLY_CRITICAL) {
            width = sqrt(-beyond);
            cosine = cos(width * interval);
            sine = sin(width * interval) / width;
        }
        fall = exp(-damping * interval);
        spring = damping * off_slope + off / square;
        off = fall * (off * cosine + drive * sine);
        off_slope = fall * (off_slope * cosine - spring * sine);
    }
    return (Vector2){{late - tau * rate + off, rate + off_slope}};
}

/* effects.force_lag.py: Return the measured force [N]; the state: output, its slope, its last input, and the stored
   samples. */
static inline Tuple25 force_lag_respond(double signal, Instant instant, Vector35 state, Vector3 values)
{
    double tau = values.v[0], delta = values.v[1], quality = values.v[2];
    double reading = state.v[0];
    double slope = state.v[1];
    double last = state.v[2];
    const Tuple23 t1 = force_lag_delayed(signal, instant, state, delta);
    double late = t1.a;
    Vector32 samples = t1.b;
    if (instant.first) {
        const double t2 = late;
        last = t2;
        reading = t2;
    }
    if (tau == 0.0) {
        reading = late;
    } else if (instant.interval > 0.0) {
        const Vector2 t3 = force_lag_low_passed((Vector3){{reading, slope, last}}, late, instant.interval, tau,
            quality);
        reading = t3.v[0];
        slope = t3.v[1];
    }
    Vector3 held = (Vector3){{reading, slope, late}};
    return (Tuple25){reading, (Vector35){{held.v[0], held.v[1], held.v[2], samples.v[0], samples.v[1], samples.v[2],
        samples.v[3], samples.v[4], samples.v[5], samples.v[6], samples.v[7], samples.v[8], samples.v[9],
        samples.v[10], samples.v[11], samples.v[12], samples.v[13], samples.v[14], samples.v[15], samples.v[16],
        samples.v[17], samples.v[18], samples.v[19], samples.v[20], samples.v[21], samples.v[22], samples.v[23],
        samples.v[24], samples.v[25], samples.v[26], samples.v[27], samples.v[28], samples.v[29], samples.v[30],
        samples.v[31]}}};
}

/* effects.force_offset.py: Shift the force [N] by F0. */
static inline Tuple8 force_offset_respond(double signal, Instant instant, Nothing state, Vector1 values)
{
    return (Tuple8){signal + values.v[0], state};
}

/* effects.force_drift.py: Add the drift since the start [N]. */
static inline Tuple8 force_drift_respond(double signal, Instant instant, Nothing state, Vector2 values)
{
    double drift = values.v[0], settling = values.v[1];
    return (Tuple8){signal + drift * settling_drift_drift_time(instant.time, settling), state};
}

/* effects.saturation.py: Return the force as read [N]. */
static inline Tuple8 saturation_respond(double signal, Instant instant, Nothing state, Vector2 values)
{
    double limit = values.v[0], knee = values.v[1];
    double beyond = signal - limit;
    if (limit >= NO_LIMIT || beyond <= -FAR * knee) {
        return (Tuple8){signal, state};
    }
    if (beyond >= FAR * knee) {
        return (Tuple8){limit, state};
    }
    return (Tuple8){signal - knee * log1p(exp(beyond / knee)), state};
}

/* flat_step.py: Return the signal after the effects of one place, and write their states after it into `n`. */
static inline double through_reading(double signal, Instant at, const double *p, const double *s, double *n)
{
    if (p[114] != 0.0 && p[3] != 0.0) {
        const Tuple25 t1 = force_lag_flow(signal, at, *(const Vector35 *)(s + 26), (Vector3){{p[115], p[116],
            p[117]}});
        signal = t1.a;
        Vector35 flowed = t1.b;
        for (int i = 0; i < 35; i++)
            n[26 + i] = flowed.v[i];
    } else if (p[114] != 0.0) {
        const Tuple25 t2 = force_lag_respond(signal, at, *(const Vector35 *)(s + 26), (Vector3){{p[115], p[116],
            p[117]}});
        signal = t2.a;
        Vector35 after = t2.b;
        for (int i = 0; i < 35; i++)
            n[26 + i] = after.v[i];
    }
    if (p[118] != 0.0) {
        const Tuple8 t3 = force_offset_respond(signal, at, (Nothing){0}, (Vector1){{p[119]}});
        signal = t3.a;
    }
    if (p[120] != 0.0) {
        const Tuple8 t4 = force_drift_respond(signal, at, (Nothing){0}, (Vector2){{p[121], p[122]}});
        signal = t4.a;
    }
    if (p[123] != 0.0) {
        const Tuple8 t5 = saturation_respond(signal, at, (Nothing){0}, (Vector2){{p[124], p[125]}});
        signal = t5.a;
    }
    return signal;
}

/* flat_step.py: Return the radial force [N] and the tire's deflection [m], and write the state after the step into
   `n`. */
Vector2 tire_step(Vector2 law, Vector7 motion, const double *p, const double *s, double *n)
{
    Tuple3 reading;
    double h;
    Vector3 later;
    Vector3 sooner;
    double above;
    Tuple3 compression;
    double A = law.v[0], B = law.v[1];
    double deflection = motion.v[0], surface_radius = motion.v[1], time = motion.v[2], rate = motion.v[3],
        acceleration = motion.v[4], pressure = motion.v[5], temperature = motion.v[6];
    double bend = fabs(surface_radius) >= FLAT_RADIUS ? 0.0 : 1.0 / surface_radius;
    bool first = s[4] == 0.0;
    double start = first ? time : s[5];
    double interval = first ? 0.0 : time - s[0];
    if (p[0] != 0.0) {
        reading = tracked_track(s, deflection, interval, p[2]);
        store_track(n, reading);
        rate = tracking_rate(reading);
        acceleration = tracking_acceleration(reading);
    }
    bool held = p[4] != 0.0;
    Tuple4 where = (Tuple4){time - start, interval, first, pressure, temperature, held, A, B, bend};
    double v = rate;
    bool differenced = p[1] != 0.0 && (p[0] == 0.0 || p[2] >= EXACT);
    if (differenced) {
        h = AHEAD;
        later = (Vector3){{deflection + h * rate, rate + h * acceleration, acceleration}};
        sooner = (Vector3){{deflection - h * rate, rate - h * acceleration, acceleration}};
        above = compressed(later, where, p, s, n);
        v = (above - compressed(sooner, where, p, s, n)) / (2.0 * h);
    }
    double x = compressed((Vector3){{deflection, rate, acceleration}}, where, p, s, n);
    if (p[1] != 0.0 && p[0] != 0.0) {
        if (differenced) {
            store_compression(n, tracking_begin(x));
        } else {
            compression = tracked_compression(s, x, interval, p[2]);
            store_compression(n, compression);
            v = tracking_rate(compression);
        }
    }
    double bare = held ? power_law_two_sided(x, A, B) : tire_elastic(x, A, B);
    double preload = held && p[6] != 0.0 ? p[5] : 0.0;
    double pretension = held && p[6] == 0.0 ? p[5] : 0.0;
    Instant at = (Instant){time - start, interval, first, x, v, acceleration, A, B, 0.0, bend, pressure,
        temperature, held, 0.0};
    bare = preload + p[7] + through_law(bare, at, p, s, n);
    double elastic = through_scale(1.0, at, p, s, n) * bare;
    at = (Instant){time - start, interval, first, x, v, acceleration, A, B, elastic, bend, pressure, temperature,
        held, preload};
    double force = through_parallel(pretension + elastic, at, p, s, n);
    if (force < 0.0 && !held) {
        force = 0.0;
    }
    force = through_mass(force, at, p, s, n);
    force = through_reading(force, at, p, s, n);
    n[0] = time;
    n[1] = deflection;
    n[2] = rate;
    n[3] = acceleration;
    n[4] = 1.0;
    n[5] = start;
    return (Vector2){{force, x}};
}

/* flat_step.py: Return the tangent dF/dx [N/m], everything but the deflection held constant; arguments as of
   `step`. */
double tire_stiffness(Vector2 law, Vector7 motion, const double *p, const double *s, double *n)
{
    double x = motion.v[0], R = motion.v[1], t = motion.v[2], v = motion.v[3], a = motion.v[4], P = motion.v[5], T =
        motion.v[6];
    const Vector2 t1 = tire_step(law, (Vector7){{x, R, t, v, a, P, T}}, p, s, n);
    double force = t1.v[0], here = t1.v[1];
    const Vector2 t2 = tire_step(law, (Vector7){{x + TANGENT_STEP, R, t, v, a, P, T}}, p, s, n);
    double above = t2.v[0], higher = t2.v[1];
    const Vector2 t3 = tire_step(law, (Vector7){{x - TANGENT_STEP, R, t, v, a, P, T}}, p, s, n);
    double below = t3.v[0], lower = t3.v[1];
    bool one_sided = p[4] == 0.0;
    if (one_sided && here <= 0.0 && higher > 0.0) {
        return (force - below) / TANGENT_STEP;
    }
    if (one_sided && here > 0.0 && lower <= 0.0) {
        return (above - force) / TANGENT_STEP;
    }
    return (above - below) / (2.0 * TANGENT_STEP);
}

/* hull1996.py: Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]; see
   `Hull1996.coefficients`. */
static inline Vector2 hull1996_coefficients(Vector10 constants, double surface_radius)
{
    double A;
    double B;
    double C0 = constants.v[0], D0 = constants.v[1], E0 = constants.v[2], D1 = constants.v[3], E1 = constants.v[4],
        C2 = constants.v[5], D2 = constants.v[6], E2 = constants.v[7], D3 = constants.v[8], E3 = constants.v[9];
    if (fabs(surface_radius) >= FLAT_RADIUS) {
        return (Vector2){{C0, C2}};
    }
    double Rb = 100.0 * surface_radius;
    if (Rb > 0.0) {
        A = C0 - D0 * exp(-E0 * Rb);
        B = C2 - D2 * exp(-E2 * Rb);
    } else {
        A = C0 + D1 * exp(E1 * Rb);
        B = C2 + D3 * exp(E3 * Rb);
    }
    return (Vector2){{A, B}};
}

/* curvature_law.py: Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]. */
static inline Vector2 curvature_law_coefficients(Vector18 slots, double surface_radius)
{
    double k1;
    double A1;
    double B1;
    double part;
    double curvature = fabs(surface_radius) >= FLAT_RADIUS ? 0.0 : 1.0 / surface_radius;
    double k0 = slots.v[0];
    double A0 = slots.v[1];
    double B0 = slots.v[2];
    if (curvature <= k0) {
        return (Vector2){{A0, B0}};
    }
    for (int i = 1; i < 6; i++) {
        k1 = slots.v[3 * i];
        A1 = slots.v[3 * i + 1];
        B1 = slots.v[3 * i + 2];
        if (A1 > 0.0) {
            if (curvature <= k1) {
                part = (curvature - k0) / (k1 - k0);
                return (Vector2){{A0 + part * (A1 - A0), B0 + part * (B1 - B0)}};
            }
            k0 = k1;
            A0 = A1;
            B0 = B1;
        }
    }
    return (Vector2){{A0, B0}};
}

/* recalibrated.py: _curvature */
static inline double recalibrated_curvature(double radius)
{
    return fabs(radius) >= FLAT_RADIUS ? 0.0 : 1.0 / radius;
}

/* recalibrated.py: Return a and b on a surface of radius `surface_radius` [m]. */
static inline Vector2 recalibrated_changes(const double *q, int at, int count, double surface_radius)
{
    double above;
    double a1;
    double b1;
    double width;
    double part;
    double here = recalibrated_curvature(surface_radius);
    double below = recalibrated_curvature(q[at]);
    double a0 = q[at + 1];
    double b0 = q[at + 2];
    for (int i = 0; i < count; i++) {
        above = recalibrated_curvature(q[at + 3 * i]);
        a1 = q[at + 3 * i + 1];
        b1 = q[at + 3 * i + 2];
        if (here <= above) {
            width = above - below;
            part = width > 0.0 ? (here - below) / width : 1.0;
            part = greater(part, 0.0);
            return (Vector2){{a0 + part * (a1 - a0), b0 + part * (b1 - b0)}};
        }
        below = above;
        a0 = a1;
        b0 = b1;
    }
    return (Vector2){{a0, b0}};
}

/* recalibrated.py: Return A exp(a) and B + b, but no exponent below 0.05. */
static inline Vector2 recalibrated_changed(double A, double B, Vector2 by)
{
    double a = by.v[0], b = by.v[1];
    return (Vector2){{A * exp(a), greater(B + b, 0.05)}};
}

/* flat_law.py: Return A [N/cm^B] and B [1] on a surface of radius `surface_radius` [m]. */
Vector2 tire_law(const double *q, double surface_radius)
{
    Vector2 law;
    int count;
    if (q[0] == HULL1996) {
        law = hull1996_coefficients(*(const Vector10 *)(q + 1), surface_radius);
    } else if (q[0] == POWER_LAW) {
        law = (Vector2){{q[1], q[2]}};
    } else {
        law = curvature_law_coefficients(*(const Vector18 *)(q + 1), surface_radius);
    }
    int at = 20;
    for (int t1 = 0; t1 < (int)q[19]; t1++) {
        count = (int)q[at];
        law = recalibrated_changed(law.v[0], law.v[1], recalibrated_changes(q, at + 1, count, surface_radius));
        at += 1 + 3 * count;
    }
    return law;
}
