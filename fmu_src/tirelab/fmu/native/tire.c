/* One tire in an FMU: reads its data, checks its inputs, and calls the kernel, in which all physics is. */
#include "tire.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#endif

#define VERSION "tirelab-tire 2"
#define MOST_BYTES (1 << 20) /* of a data file: a tire of a thousand surfaces has 50 kB */

static const double FLAT = 1e5;    /* start value of the surface radius [m] */
static const double ON_TIME = 1e-3; /* part of a step by which a time may be off: hosts add times up in their own ways */

/* Reading the data. */

static int hexadecimal(char digit)
{
    if (digit >= '0' && digit <= '9')
        return digit - '0';
    if (digit >= 'a' && digit <= 'f')
        return digit - 'a' + 10;
    return digit >= 'A' && digit <= 'F' ? digit - 'A' + 10 : -1;
}

/* The path of file:///a%20b, file:/a, file://localhost/a or a plain path, with the name of a file after it. */
static void path_of(const char *location, const char *name, bool encoded, char path[], size_t size)
{
    size_t used = 0;
    if (encoded) {
        static const char scheme[] = "file:";
        size_t i = 0;
        while (scheme[i] && (location[i] | 32) == (scheme[i] | 32))
            i++;
        if (!scheme[i]) {
            location += i;
            if (!strncmp(location, "//localhost/", 12))
                location += 11;
            else if (!strncmp(location, "///", 3))
                location += 2;
        }
#ifdef _WIN32
        if (location[0] == '/' && location[1] && (location[2] == ':' || location[2] == '|'))
            location++; /* /C:/folder */
#endif
    }
    for (; *location && used + 1 < size; location++) {
        const bool code = encoded && *location == '%' && hexadecimal(location[1]) >= 0 && hexadecimal(location[2]) >= 0;
        path[used++] = code ? (char)(16 * hexadecimal(location[1]) + hexadecimal(location[2])) : *location;
        location += code ? 2 : 0;
    }
    if (used && (path[used - 1] == '/' || path[used - 1] == '\\'))
        used--;
    path[used] = 0;
    snprintf(path + used, size - used, "/%s", name);
}

static FILE *open_file(const char *path)
{
#ifdef _WIN32
    wchar_t wide[4096];
    if (!MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, 4096))
        return NULL;
    return _wfopen(wide, L"rb");
#else
    return fopen(path, "rb");
#endif
}

static char *read_file(const char *resources, char trouble[TROUBLE])
{
    char path[4096];
    FILE *file = NULL;
    if (!resources || !*resources) {
        snprintf(trouble, TROUBLE, "no resource location was given; give that of the unpacked FMU");
        return NULL;
    }
    for (int encoded = 1; encoded >= 0 && !file; encoded--) {
        path_of(resources, "tire.dat", encoded, path, sizeof path);
        file = open_file(path);
    }
    if (!file) {
        snprintf(trouble, TROUBLE, "no tire.dat in the resource location '%.400s'; unpack the FMU anew", resources);
        return NULL;
    }
    char *text = malloc(MOST_BYTES + 1);
    size_t length = text ? fread(text, 1, MOST_BYTES, file) : 0;
    fclose(file);
    if (!text) {
        snprintf(trouble, TROUBLE, "no memory to read tire.dat");
        return NULL;
    }
    text[length] = 0;
    if (strlen(text) != length)
        text[0] = 0;
    char *less = realloc(text, length + 1);
    return less ? less : text;
}

/* FNV-1a. */
static uint64_t checksum(const char *bytes, size_t count)
{
    uint64_t sum = 14695981039346656037u;
    for (size_t i = 0; i < count; i++)
        sum = (sum ^ (unsigned char)bytes[i]) * 1099511628211u;
    return sum;
}

/* The next word of the data, cut off behind; "" at the end. */
static char *word(char **at)
{
    char *start = *at + strspn(*at, " \n");
    char *end = start + strcspn(start, " \n");
    *at = *end ? end + 1 : end;
    *end = 0;
    return start;
}

/* The next number: 16 hexadecimal digits are the bits of a double. */
static bool bits(char **at, double *value)
{
    const char *digits = word(at);
    uint64_t found = 0;
    if (strlen(digits) != 16)
        return false;
    for (int i = 0; i < 16; i++) {
        if (hexadecimal(digits[i]) < 0)
            return false;
        found = 16 * found + (uint64_t)hexadecimal(digits[i]);
    }
    memcpy(value, &found, sizeof found);
    return true;
}

static bool count(char **at, long most, long *value)
{
    char *end;
    const char *digits = word(at);
    *value = strtol(digits, &end, 10);
    return *digits && !*end && *value >= 0 && *value <= most;
}

static bool is(char **at, const char *expected) { return !strcmp(word(at), expected); }

static double *row(char **at, const char *name, long most, size_t *length)
{
    long number;
    double *values = NULL;
    if (!is(at, name) || !count(at, most, &number) || !(values = malloc(sizeof(double) * ((size_t)number + 1))))
        return NULL;
    for (long i = 0; i < number; i++)
        if (!bits(at, values + i)) {
            free(values);
            return NULL;
        }
    *length = (size_t)number;
    return values;
}

/* Whether the tables after the law's parameters end where the row ends. */
static bool tables_fit(const double *q, size_t length)
{
    size_t at = LAW_TABLES + 1;
    if (length < at || !(q[0] == 0 || q[0] == 1 || q[0] == 2) || !(q[LAW_TABLES] >= 0 && q[LAW_TABLES] <= 100))
        return false;
    for (int i = 0; i < (int)q[LAW_TABLES]; i++) {
        if (at >= length || !(q[at] >= 1 && q[at] <= 1e4))
            return false;
        at += 1 + 3 * (size_t)q[at];
    }
    return at == length;
}

static bool parse(Tire *tire, char *at)
{
    size_t length;
    long number, index, whole;
    if (!is(&at, "guid"))
        return false;
    snprintf(tire->guid, sizeof tire->guid, "%s", word(&at));
    if (!(tire->q = row(&at, "law", MOST_BYTES, &tire->law)) || !tables_fit(tire->q, tire->law))
        return false;
    if (!(tire->p = row(&at, "effects", PARAMETERS, &length)) || length != PARAMETERS)
        return false;
    double *range = row(&at, "range", 4, &length);
    if (!range || (length != 0 && length != 4)) {
        free(range);
        return false;
    }
    tire->tested = length == 4;
    memcpy(tire->range, range, length * sizeof *range);
    free(range);
    if (!is(&at, "bare") || !count(&at, 1, &number))
        return false;
    tire->bare = number;
    if (!is(&at, "continuous") || !count(&at, MOST_CONTINUOUS, &number))
        return false;
    tire->continuous_count = (int)number;
    for (int i = 0; i < tire->continuous_count; i++) {
        if (!count(&at, STATES - 1, &index) || !count(&at, STATES - 1, &whole))
            return false;
        tire->continuous[i] = (int)index;
        tire->whole[i] = (int)whole;
    }
    if (!is(&at, "parameters") || !count(&at, 1000, &number))
        return false;
    if (!(tire->parameters = calloc((size_t)number + 1, sizeof(Parameter))))
        return false;
    tire->count = (int)number;
    for (int i = 0; i < tire->count; i++) {
        Parameter *one = tire->parameters + i;
        snprintf(one->name, sizeof one->name, "%s", word(&at));
        const char *kind = word(&at);
        one->row = *kind == 'q' ? OF_LAW : OF_EFFECTS;
        const long most = one->row == OF_LAW ? LAW_TABLES - 1 : PARAMETERS - 1;
        if (!*one->name || (strcmp(kind, "q") && strcmp(kind, "p")) || !count(&at, most, &index)
            || !bits(&at, &one->minimum) || !bits(&at, &one->maximum))
            return false;
        one->index = (int)index;
    }
    if (!is(&at, "channels") || !count(&at, CHANNELS, &number))
        return false;
    tire->channel_count = (int)number;
    for (int i = 0; i < tire->channel_count; i++) {
        Channel *one = tire->channels + i;
        snprintf(one->name, sizeof one->name, "%s", word(&at));
        if (!*one->name || !count(&at, CHANNELS - 1, &index) || !bits(&at, &one->start) || !bits(&at, &one->minimum)
            || !bits(&at, &one->maximum) || !bits(&at, &one->unknown))
            return false;
        one->number = (int)index;
    }
    tire->moves = tire->p[P_TRACKED] != 0;
    tire->deflection_max =
        tire->p[P_TWO_SIDED] != 0 || tire->p[P_INFLATED] == 0 ? -DEFLECTION_MIN : DEFLECTION_MAX;
    if (*word(&at) || !(tire->start = malloc(sizeof(double) * (tire->law + PARAMETERS))))
        return false;
    memcpy(tire->start, tire->q, sizeof(double) * tire->law);
    memcpy(tire->start + tire->law, tire->p, sizeof(double) * PARAMETERS);
    return true;
}

bool tire_read(Tire *tire, const char *resources, const char *guid, char trouble[TROUBLE])
{
    static const char broken[] = "tire.dat is cut off or was changed; build the FMU again";
    char *text = read_file(resources, trouble), *end = text;
    if (!text)
        return false;
    /* The first line names version and layout, the last one holds the sum of all before it. */
    if (strncmp(text, VERSION " ", strlen(VERSION) + 1)) {
        snprintf(trouble, TROUBLE, "%s", strncmp(text, "tirelab-tire ", 13) ? broken
                 : "tire.dat was written for another version of this binary; build the FMU again");
        free(text);
        return false;
    }
    for (char *next = text; (next = strstr(next, "\nend ")); next++)
        end = next + 1;
    char *sum = end + 4;
    double stated, found;
    const uint64_t computed = checksum(text, (size_t)(end - text));
    memcpy(&found, &computed, sizeof found);
    char *rest = sum;
    if (end == text || !bits(&rest, &stated) || memcmp(&stated, &found, sizeof found) || *word(&rest)) {
        snprintf(trouble, TROUBLE, "%s", broken);
        free(text);
        return false;
    }
    *end = 0;
    rest = text + strlen(VERSION);
    if (!is(&rest, LAYOUT)) {
        snprintf(trouble, TROUBLE, "tire.dat was written for another version of this binary; build the FMU again");
        free(text);
        return false;
    }
    const bool read = parse(tire, rest);
    free(text);
    if (!read) {
        snprintf(trouble, TROUBLE, "%s", broken);
        return false;
    }
    if (!guid || strcmp(guid, tire->guid)) {
        snprintf(trouble, TROUBLE, "the GUID %.80s is not that of this FMU, %s; unpack it anew", guid ? guid : "NULL",
                 tire->guid);
        return false;
    }
    return true;
}

void tire_free(Tire *tire)
{
    free(tire->q);
    free(tire->p);
    free(tire->start);
    free(tire->parameters);
}

void tire_give_motion(Tire *tire, bool given)
{
    tire->m.given = given;
    tire->current = false;
}

/* Whether a law can be computed with its parameters, beyond the bounds of each; a sentence where it cannot. */
static bool law_fits(const Tire *tire, char trouble[TROUBLE])
{
    const double *q = tire->q + 1;
    if (q[-1] == 0) { /* Hull 1996 */
        if (q[1] >= q[0]) {
            snprintf(trouble, TROUBLE, "law.convex_coefficient_drop = %g is not allowed; it must be less than "
                     "flat_coefficient = %g, or A is negative on sharp bumps", q[1], q[0]);
            return false;
        }
        if (q[6] >= q[5]) {
            snprintf(trouble, TROUBLE, "law.convex_exponent_drop = %g is not allowed; it must be less than "
                     "flat_exponent = %g, or B is negative on sharp bumps", q[6], q[5]);
            return false;
        }
    }
    if (q[-1] == 2) { /* coefficients over the curvature */
        double lower = q[0];
        for (int i = 3; i < LAW_TABLES - 1; i += 3)
            if (q[i + 1] > 0) {
                if (!(lower < q[i])) {
                    snprintf(trouble, TROUBLE, "law.the surfaces' curvatures must rise, but %g 1/m follows %g 1/m; put "
                             "them in order", q[i], lower);
                    return false;
                }
                lower = q[i];
            }
    }
    return true;
}

static double *place(const Tire *tire, const Parameter *one)
{
    return (one->row == OF_LAW ? tire->q : tire->p) + one->index;
}

static bool checked(Tire *tire, char trouble[TROUBLE])
{
    for (int i = 0; i < tire->count; i++) {
        const Parameter *one = tire->parameters + i;
        const double value = *place(tire, one);
        if (!(one->minimum <= value && value <= one->maximum)) {
            snprintf(trouble, TROUBLE, "%s = %.17g is not allowed; it must lie between %g and %g", one->name, value,
                     one->minimum, one->maximum);
            return false;
        }
    }
    if (!law_fits(tire, trouble))
        return false;
    tire->unchecked = false;
    tire->surface = NAN;
    return true;
}

/* The motion as the kernel takes it; a channel that the tire does not read, or that is not known, is not a number. */
static Motion moving(const Tire *tire, double time)
{
    const Inputs *u = &tire->m.inputs;
    Motion motion = {{u->deflection, u->radius, time, u->rate, u->acceleration}};
    for (int i = 0; i < CHANNELS; i++)
        motion.v[5 + i] = NAN;
    for (int i = 0; i < tire->channel_count; i++)
        if (u->channels[i] != tire->channels[i].unknown)
            motion.v[5 + tire->channels[i].number] = u->channels[i];
    return motion;
}

static bool channels_fit(const Tire *tire, char trouble[TROUBLE])
{
    for (int i = 0; i < tire->channel_count; i++) {
        const Channel *one = tire->channels + i;
        const double value = tire->m.inputs.channels[i];
        if (!(one->minimum <= value && value <= one->maximum)) {
            snprintf(trouble, TROUBLE, "%s = %.17g is not allowed; it must lie between %g and %g", one->name, value,
                     one->minimum, one->maximum);
            return false;
        }
    }
    return true;
}

/*
 * What was kept before a time. A step of a solver that ends no later than the last one takes its place: OpenModelica
 * completes one whenever it evaluates its model, in a solver's iterations too and, for its results, at times gone by.
 */
static double *kept(Tire *tire, double time)
{
    Memory *const m = &tire->m;
    if (!tire->exchange || time > m->reached)
        return m->s;
    for (int i = 0; i < tire->continuous_count; i++)
        m->earlier[tire->continuous[i]] = m->s[tire->continuous[i]];
    return m->earlier;
}

bool tire_try(Tire *tire, double time, char trouble[TROUBLE])
{
    const Inputs *const u = &tire->m.inputs; /* a copy would wait for both inputs to be written */
    tire->current = true;
    tire->force = NAN;
    if (!(DEFLECTION_MIN <= u->deflection && u->deflection <= tire->deflection_max)) {
        const bool of_tire = tire->deflection_max == DEFLECTION_MAX;
        snprintf(trouble, TROUBLE, "deflection = %.17g m is not allowed; it must lie between %g m%s and %g m%s",
                 u->deflection, DEFLECTION_MIN, of_tire ? " (wheel in the air)" : "", tire->deflection_max,
                 of_tire ? " (the wheel's radius)" : "");
        return false;
    }
    if (!(u->radius > 0 || u->radius < 0)) {
        snprintf(trouble, TROUBLE, "surface_radius = %.17g m is not allowed; it must be positive (convex), negative "
                 "(concave), or infinite (flat)", u->radius);
        return false;
    }
    if (!channels_fit(tire, trouble))
        return false;
    if (tire->unchecked && !checked(tire, trouble))
        return false;
    if (u->radius != tire->surface) {
        tire->coefficients = tire_law(tire->q, u->radius);
        tire->surface = u->radius;
    }
    double force, compression = u->deflection;
    if (tire->bare) {
        force = tire_elastic(u->deflection, tire->coefficients.v[0], tire->coefficients.v[1]);
    } else {
        const bool given = tire->moves && (tire->exchange || tire->m.given != 0);
        if (given && !(isfinite(u->rate) && isfinite(u->acceleration))) {
            snprintf(trouble, TROUBLE, "deflection_rate = %.17g m/s or deflection_acceleration = %.17g m/s^2 is not "
                     "allowed; both must be finite", u->rate, u->acceleration);
            return false;
        }
        tire->p[P_TRACKED] = tire->moves && !given;
        tire->p[P_CONTINUOUS] = tire->exchange;
        const Vector2 answer = tire_step(tire->coefficients, moving(tire, time), tire->p, kept(tire, time), tire->n);
        force = answer.v[0];
        compression = answer.v[1];
    }
    if (!isfinite(force)) {
        snprintf(trouble, TROUBLE, "radial_force is not finite at deflection = %.17g m, surface_radius = %.17g m",
                 u->deflection, u->radius);
        return false;
    }
    tire->force = force;
    tire->compression = compression;
    return true;
}

bool tire_accept(Tire *tire, double time, char trouble[TROUBLE])
{
    if (!tire_try(tire, time, trouble)) {
        tire->current = false;
        return false;
    }
    const bool later = time > tire->m.reached;
    tire->m.time = tire->m.reached = time;
    if (tire->bare)
        return true;
    if (tire->exchange && later)
        memcpy(tire->m.earlier, tire->m.s, sizeof tire->m.s);
    double states[MOST_CONTINUOUS];
    const bool first = tire->m.s[S_STARTED] == 0;
    for (int i = 0; i < tire->continuous_count; i++) /* a solver's are not ours to change, but at the start */
        states[i] = (first ? tire->n : tire->m.s)[tire->continuous[i]];
    memcpy(tire->m.s, tire->n, sizeof tire->n);
    for (int i = 0; tire->exchange && i < tire->continuous_count; i++)
        tire->m.s[tire->continuous[i]] = states[i];
    return true;
}

bool tire_begin(Tire *tire, double start, char trouble[TROUBLE])
{
    memcpy(tire->m.s, REST, sizeof tire->m.s);
    memcpy(tire->n, REST, sizeof tire->n);
    tire_settle(tire);
    const bool fits = tire_accept(tire, start, trouble);
    tire_settle(tire);
    return fits;
}

void tire_settle(Tire *tire) { memcpy(tire->m.earlier, tire->m.s, sizeof tire->m.s); }

void tire_reset(Tire *tire)
{
    memcpy(tire->q, tire->start, sizeof(double) * tire->law);
    memcpy(tire->p, tire->start + tire->law, sizeof(double) * PARAMETERS);
    memset(&tire->m, 0, sizeof tire->m);
    memcpy(tire->m.s, REST, sizeof tire->m.s);
    memcpy(tire->n, REST, sizeof tire->n);
    tire_settle(tire);
    tire->m.inputs.radius = FLAT;
    for (int i = 0; i < tire->channel_count; i++)
        tire->m.inputs.channels[i] = tire->channels[i].start;
    tire->m.stop = INFINITY;
    tire->m.stage = INSTANTIATED;
    tire->current = false;
    tire->unchecked = true;
    tire->surface = NAN;
    tire->force = NAN;
}

/* Whether steps keep, in the place of a solver's state, what is missing from it to a whole. */
static bool complements(const Tire *tire, int state)
{
    return !tire->exchange && tire->whole[state] != tire->continuous[state];
}

void tire_flow(Tire *tire, double states[], double rates[])
{
    const bool first = tire->m.s[S_STARTED] == 0; /* the try has found the states to begin with */
    double s[STATES], n[STATES];
    memcpy(s, first ? tire->n : kept(tire, tire->m.time), sizeof s);
    for (int i = 0; i < tire->continuous_count; i++) {
        const int at = tire->continuous[i];
        if (complements(tire, i))
            s[at] = s[tire->whole[i]] - s[at];
        states[i] = s[at];
    }
    s[S_STARTED] = 1;
    tire->p[P_CONTINUOUS] = 1;
    tire_step(tire->coefficients, moving(tire, tire->m.time), tire->p, s, n);
    tire->p[P_CONTINUOUS] = tire->exchange;
    for (int i = 0; i < tire->continuous_count; i++)
        rates[i] = isfinite(tire->force) ? n[tire->continuous[i]] : NAN;
}

double tire_tangent(Tire *tire)
{
    if (!isfinite(tire->force))
        return NAN;
    const Inputs u = tire->m.inputs;
    if (tire->bare)
        return tire_elastic_tangent(u.deflection, tire->coefficients.v[0], tire->coefficients.v[1]);
    double scratch[STATES];
    return tire_stiffness(tire->coefficients, moving(tire, tire->m.time), tire->p, kept(tire, tire->m.time), scratch);
}

/* The number of the channel that a reference is, or -1. */
static int channel_variable(const Tire *tire, unsigned reference)
{
    const unsigned first = FIRST_PARAMETER + (unsigned)tire->count;
    return reference >= first && reference - first < (unsigned)tire->channel_count ? (int)(reference - first) : -1;
}

static double *variable(Tire *tire, unsigned reference);
static bool is_parameter(const Tire *tire, unsigned reference)
{
    return reference >= FIRST_PARAMETER && reference - FIRST_PARAMETER < (unsigned)tire->count;
}

/* How far a variable is moved for a difference: of its usual size 1e-7 to 1e-5, so that rounding is 1e-9 of it. */
static double reach(const Tire *tire, unsigned reference, double value)
{
    const int channel = channel_variable(tire, reference);
    if (channel >= 0)
        return 1e-6 * fmax(1, fabs(tire->m.inputs.channels[channel]));
    if (reference == DEFLECTION)
        return 1e-7;
    if (reference == SURFACE_RADIUS || is_parameter(tire, reference))
        return value ? 1e-6 * fabs(value) : 1e-6;
    return tire_motion_variable(tire, reference) >= 0 ? 1e-6 : 1e-4;
}

/* The place of an input, a parameter, a state or, in FMI 3.0, the time, by which a derivative can be asked for. */
static double *moved(Tire *tire, unsigned reference)
{
    if (tire->newer && reference == tire_references(tire))
        return &tire->m.time;
    const int state = tire_state_variable(tire, reference);
    if (state >= 0)
        return state < tire->continuous_count ? tire->m.s + tire->continuous[state] : NULL;
    return variable(tire, reference);
}

bool tire_derivative(Tire *tire, unsigned unknown, const unsigned known[], const double seed[], size_t count,
                     double *value)
{
    char trouble[TROUBLE];
    const Memory before = tire->m;
    const bool radius_kept = isinf(before.inputs.radius) || fabs(before.inputs.radius) >= FLAT;
    double width = INFINITY, sides[2], law[LAW_TABLES], effects[PARAMETERS];
    *value = 0;
    for (size_t i = 0; i < count; i++) {
        const double *place = moved(tire, known[i]);
        if (!place)
            return false;
        if (seed[i] != 0 && !(known[i] == SURFACE_RADIUS && radius_kept))
            width = fmin(width, reach(tire, known[i], *place) / fabs(seed[i]));
    }
    if (!isfinite(width))
        return true;
    if (count == 1 && known[0] == DEFLECTION && unknown == RADIAL_FORCE) { /* knows the side of the contact */
        *value = seed[0] * tire_tangent(tire);
        return true;
    }
    if (unknown == RADIAL_STIFFNESS) /* is a difference itself */
        width *= 100;
    memcpy(law, tire->q, sizeof law);
    memcpy(effects, tire->p, sizeof effects);
    for (int side = 0; side < 2; side++) {
        for (size_t i = 0; i < count; i++) {
            const int state = tire_state_variable(tire, known[i]);
            const bool turned = state >= 0 && complements(tire, state);
            if (!(known[i] == SURFACE_RADIUS && radius_kept))
                *moved(tire, known[i]) += (side != turned ? -width : width) * seed[i];
        }
        tire->surface = NAN;
        tire_try(tire, tire->m.time, trouble);
        tire_get(tire, unknown, sides + side);
        tire->m = before;
        memcpy(tire->q, law, sizeof law);
        memcpy(tire->p, effects, sizeof effects);
    }
    tire->surface = NAN;
    tire_try(tire, tire->m.time, trouble);
    *value = (sides[0] - sides[1]) / (2 * width);
    return true;
}

/* By how much a time may be off that hosts add up in their own ways. */
static double off(double time, double step) { return ON_TIME * step + 1e-9 * (fabs(time) > 1 ? fabs(time) : 1); }

static bool step_fits(const Tire *tire, double time, double step, char trouble[TROUBLE])
{
    if (!(step >= 0 && step < INFINITY)) {
        snprintf(trouble, TROUBLE, "communicationStepSize = %.17g s is not allowed; it must be positive and finite", step);
        return false;
    }
    if (time + step > tire->m.stop + off(tire->m.stop, step)) {
        snprintf(trouble, TROUBLE, "communicationStepSize = %.17g s is not allowed; the step would end at %.17g s, after "
                 "stopTime = %.17g s", step, time + step, tire->m.stop);
        return false;
    }
    if (!(fabs(time - tire->m.reached) <= off(tire->m.reached, step))) {
        snprintf(trouble, TROUBLE, "currentCommunicationPoint = %.17g s is not allowed; it must be %.17g s, the end of the "
                 "last step", time, tire->m.reached);
        return false;
    }
    return true;
}

bool tire_advance(Tire *tire, double time, double step, char trouble[TROUBLE])
{
    return step_fits(tire, time, step, trouble) && tire_accept(tire, time + step, trouble);
}

bool tire_in_range(const Tire *tire)
{
    const double bend = 1 / tire->m.inputs.radius;
    return tire->tested && isfinite(tire->force) && tire->range[0] <= bend && bend <= tire->range[1]
           && tire->m.inputs.deflection <= tire->range[2] && tire->force <= tire->range[3];
}

/* Variables. */

int tire_motion_variable(const Tire *tire, unsigned reference)
{
    const unsigned first = FIRST_PARAMETER + (unsigned)(tire->count + tire->channel_count);
    return tire->moves && reference >= first && reference - first < MOTION_VARIABLES ? (int)(reference - first) : -1;
}

bool tire_is_motion_given(const Tire *tire, unsigned reference)
{
    return tire_motion_variable(tire, reference) == MOTION_GIVEN;
}

int tire_state_variable(const Tire *tire, unsigned reference)
{
    const unsigned first =
        FIRST_PARAMETER + (unsigned)(tire->count + tire->channel_count) + (tire->moves ? MOTION_VARIABLES : 0);
    const bool known = reference >= first && reference - first < 2 * (unsigned)tire->continuous_count;
    return known ? (int)(reference - first) : -1;
}

unsigned tire_references(const Tire *tire)
{
    return FIRST_PARAMETER + (unsigned)(tire->count + tire->channel_count) + (tire->moves ? MOTION_VARIABLES : 0)
           + 2 * (unsigned)tire->continuous_count;
}

static double *variable(Tire *tire, unsigned reference)
{
    Inputs *u = &tire->m.inputs;
    if (reference == DEFLECTION)
        return &u->deflection;
    if (reference == SURFACE_RADIUS)
        return &u->radius;
    if (is_parameter(tire, reference))
        return place(tire, tire->parameters + (reference - FIRST_PARAMETER));
    if (channel_variable(tire, reference) >= 0)
        return u->channels + channel_variable(tire, reference);
    const int motion = tire_motion_variable(tire, reference);
    return motion == DEFLECTION_RATE ? &u->rate : motion == DEFLECTION_ACCELERATION ? &u->acceleration : NULL;
}

bool tire_get(Tire *tire, unsigned reference, double *value)
{
    if (reference == RADIAL_FORCE)
        *value = tire->force;
    else if (reference == RADIAL_STIFFNESS)
        *value = tire_tangent(tire);
    else if (tire->newer && reference == tire_references(tire) + 1)
        *value = tire->compression;
    else {
        int number;
        const double *found = variable(tire, reference);
        double flow[2 * MOST_CONTINUOUS];
        if (!found && (number = tire_state_variable(tire, reference)) >= 0) {
            tire_flow(tire, flow, flow + tire->continuous_count);
            found = flow + number;
        }
        if (!found)
            return false;
        *value = *found;
    }
    return true;
}

/* A solver's state, which a host of FMI 3.0 may set as a variable; or NULL. */
static double *solved(Tire *tire, unsigned reference)
{
    const int number = tire_state_variable(tire, reference);
    const bool open = tire->newer && tire->exchange && tire->m.stage & (EVENT | CONTINUOUS);
    return open && 0 <= number && number < tire->continuous_count ? tire->m.s + tire->continuous[number] : NULL;
}

bool tire_can_set(Tire *tire, unsigned reference) { return variable(tire, reference) || solved(tire, reference); }

bool tire_set(Tire *tire, unsigned reference, double value)
{
    double *found = variable(tire, reference);
    if (!found && !(found = solved(tire, reference)))
        return false;
    *found = value;
    tire->current = false;
    if (is_parameter(tire, reference)) {
        tire->unchecked = true;
        tire->surface = NAN;
    }
    return true;
}

/* States. */

#define MARK "tirelab-state 1 " LAYOUT

size_t tire_state_size(const Tire *tire)
{
    return sizeof MARK + sizeof tire->guid + sizeof(Memory) + sizeof(double) * (tire->law + PARAMETERS) + sizeof(uint64_t);
}

void tire_save(const Tire *tire, char *bytes)
{
    char *at = bytes;
#define PUT(what, size) (memcpy(at, what, size), at += (size))
    PUT(MARK, sizeof MARK);
    PUT(tire->guid, sizeof tire->guid);
    PUT(&tire->m, sizeof(Memory));
    PUT(tire->q, sizeof(double) * tire->law);
    PUT(tire->p, sizeof(double) * PARAMETERS);
    const uint64_t sum = checksum(bytes, (size_t)(at - bytes));
    PUT(&sum, sizeof sum);
}

bool tire_is_state(const Tire *tire, const char *bytes, size_t size, char trouble[TROUBLE])
{
    const char *at = bytes + sizeof MARK;
    const size_t whole = tire_state_size(tire);
    uint64_t sum = 0;
    if (size == whole)
        memcpy(&sum, bytes + whole - sizeof sum, sizeof sum);
    if (size != whole || memcmp(bytes, MARK, sizeof MARK) || memcmp(at, tire->guid, sizeof tire->guid)
        || sum != checksum(bytes, whole - sizeof sum)) {
        snprintf(trouble, TROUBLE, "these bytes are no state of this FMU, or a part of one; save one anew");
        return false;
    }
    Memory memory;
    at += sizeof tire->guid;
    memcpy(&memory, at, sizeof memory);
    at += sizeof memory;
    const int both = INSTANTIATED | INITIALIZATION | TERMINATED;
    if (!(memory.stage & (both | (tire->exchange ? EVENT | CONTINUOUS : STEP_COMPLETE)))) {
        snprintf(trouble, TROUBLE, "this state is not one of %s; restore it in an instance of its own kind",
                 tire->exchange ? "Model Exchange" : "Co-Simulation");
        return false;
    }
    /* What no call can change: the kind of law, and its tables with their lengths. */
    if (memcmp(at, tire->start, sizeof(double))
        || memcmp(at + sizeof(double) * LAW_TABLES, tire->start + LAW_TABLES, sizeof(double) * (tire->law - LAW_TABLES))) {
        snprintf(trouble, TROUBLE, "these bytes are a state of another tire; save one anew");
        return false;
    }
    return true;
}

bool tire_restore(Tire *tire, const char *bytes, size_t size, char trouble[TROUBLE])
{
    const char *at = bytes + sizeof MARK;
    if (!tire_is_state(tire, bytes, size, trouble))
        return false;
#define TAKE(what, size) (memcpy(what, at, size), at += (size))
    at += sizeof tire->guid;
    TAKE(&tire->m, sizeof(Memory));
    TAKE(tire->q, sizeof(double) * tire->law);
    TAKE(tire->p, sizeof(double) * PARAMETERS);
    memcpy(tire->n, tire->m.s, sizeof tire->n);
    tire->current = false;
    tire->unchecked = true;
    tire->surface = NAN;
    return true;
}
