/* What the calls of FMI 2.0 and 3.0 do alike. */
#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

Status tell(const Instance *self, Status status, String text)
{
    static const char *const categories[] = {"logAll", "logStatusWarning", "logStatusDiscard", "logStatusError",
                                             "logStatusFatal", "logAll"};
    if (self->logger && !(self->quiet && status == DISCARD))
        self->teller(self, status, categories[status], text);
    return status;
}

Status fail(const Instance *self, String format, ...)
{
    char text[TROUBLE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return tell(self, ERROR, text);
}

static State stage(const Instance *self) { return (State)self->tire.m.stage; }

bool not_allowed(const Instance *self, String function)
{
    fail(self, "%s is not allowed in the state \"%s\" of %s", function, state_name(stage(self)),
         self->tire.exchange ? "Model Exchange" : "Co-Simulation");
    return false;
}

/* Values for the inputs as they are now; a message only where `heard`: in co-simulation the step has one. */
static Status evaluated(Instance *self, bool heard)
{
    char trouble[TROUBLE];
    return tire_try(&self->tire, self->tire.m.time, trouble) || !heard ? OK : tell(self, DISCARD, trouble);
}

static inline Status evaluate(Instance *self, bool heard)
{
    return self->tire.current && (!heard || isfinite(self->tire.force)) ? OK : evaluated(self, heard);
}

Instance *instance_new(Instance how, String name, String guid, String resources)
{
    char trouble[TROUBLE];
    Instance *self = malloc(sizeof *self);
    if (!self)
        return NULL;
    *self = how;
    const size_t length = strlen(name ? name : "") + 1;
    self->name = malloc(length);
    if (self->name) {
        memcpy(self->name, name ? name : "", length);
        if (tire_read(&self->tire, resources, guid, trouble)) {
            tire_reset(&self->tire);
            return self;
        }
        tell(self, ERROR, trouble);
    }
    instance_free(self);
    return NULL;
}

void instance_free(Instance *self)
{
    if (!self)
        return;
    tire_free(&self->tire);
    free(self->name);
    free(self);
}

Status instance_start_at(Instance *self, double start, bool has_stop, double stop)
{
    if (!isfinite(start))
        return fail(self, "startTime = %.17g s is not allowed; it must be a finite number", start);
    if (has_stop && !(stop >= start))
        return fail(self, "stopTime = %.17g s is not allowed; it must not lie before startTime = %.17g s", stop, start);
    self->tire.m.time = self->tire.m.reached = start;
    self->tire.m.stop = has_stop ? stop : INFINITY;
    return OK;
}

Status instance_begin(Instance *self)
{
    char trouble[TROUBLE];
    if (!tire_begin(&self->tire, self->tire.m.reached, trouble))
        return tell(self, ERROR, trouble);
    self->tire.m.stage = self->tire.exchange ? EVENT : STEP_COMPLETE;
    self->tire.current = false;
    return OK;
}

/* Variables. */

bool given(const Instance *self, const void *references, size_t n, const void *values)
{
    if (!n || (references && values))
        return true;
    fail(self, "references or values are NULL");
    return false;
}

Status instance_get_any(Instance *self, const Reference v[], size_t n, double x[])
{
    if (!given(self, v, n, x))
        return ERROR;
    Status status = evaluate(self, self->tire.exchange && !(stage(self) & (INSTANTIATED | INITIALIZATION)));
    for (size_t i = 0; i < n; i++)
        if (v[i] == RADIAL_FORCE)
            x[i] = self->tire.force;
        else if (!tire_get(&self->tire, v[i], x + i))
            return fail(self, "value reference %u is no Real variable of this tire", v[i]);
    return status;
}

Status instance_set_any(Instance *self, const Reference v[], size_t n, const double x[])
{
    if (!given(self, v, n, x))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        if (v[i] > SURFACE_RADIUS && !tire_can_set(&self->tire, v[i]))
            return v[i] == RADIAL_FORCE || v[i] == RADIAL_STIFFNESS
                       ? fail(self, "%s = %.17g cannot be set; set inputs and parameters only",
                              v[i] == RADIAL_FORCE ? "radial_force" : "radial_stiffness", x[i])
                       : fail(self, "value reference %u = %.17g cannot be set; set inputs and parameters only", v[i], x[i]);
    Inputs *const u = &self->tire.m.inputs;
    self->tire.current = false;
    for (size_t i = 0; i < n; i++) /* the inputs first: no call */
        if (v[i] == DEFLECTION)
            u->deflection = x[i];
        else if (v[i] == SURFACE_RADIUS)
            u->radius = x[i];
        else
            tire_set(&self->tire, v[i], x[i]);
    return OK;
}

Status instance_get_boolean(Instance *self, Reference v, bool *x)
{
    evaluate(self, false);
    if (v == IN_TESTED_RANGE)
        *x = tire_in_range(&self->tire);
    else if (tire_is_motion_given(&self->tire, v))
        *x = self->tire.m.given != 0;
    else
        return fail(self, "value reference %u is no Boolean variable of this tire", v);
    return OK;
}

bool instance_has_booleans(Instance *self, const Reference v[], size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!tire_is_motion_given(&self->tire, v[i])) {
            fail(self, "value reference %u cannot be set as a Boolean; set motion_given only", v[i]);
            return false;
        }
    return true;
}

/* States of the FMU. */

Status instance_save(Instance *self, void **state)
{
    if (!state)
        return fail(self, "the place for the state is NULL");
    if (!*state)
        *state = malloc(tire_state_size(&self->tire));
    if (!*state)
        return fail(self, "no memory for a state");
    tire_save(&self->tire, *state);
    return OK;
}

Status instance_restore(Instance *self, const void *state)
{
    char trouble[TROUBLE];
    if (!state)
        return fail(self, "the state is NULL");
    return tire_restore(&self->tire, state, tire_state_size(&self->tire), trouble) ? OK : tell(self, ERROR, trouble);
}

Status instance_forget(void **state)
{
    if (state) {
        free(*state);
        *state = NULL;
    }
    return OK;
}

Status instance_state_size(const Instance *self, size_t *size)
{
    if (!size)
        return fail(self, "the place for the size is NULL");
    *size = tire_state_size(&self->tire);
    return OK;
}

Status instance_write(const Instance *self, const void *state, char bytes[], size_t size)
{
    if (!state || !bytes || size < tire_state_size(&self->tire))
        return fail(self, "the place for the bytes of a state is NULL or too small");
    memcpy(bytes, state, tire_state_size(&self->tire));
    return OK;
}

Status instance_read(const Instance *self, const char bytes[], size_t size, void **state)
{
    char trouble[TROUBLE];
    if (!bytes || !state)
        return fail(self, "the bytes or the place for the state are NULL");
    if (!tire_is_state(&self->tire, bytes, size, trouble))
        return tell(self, ERROR, trouble);
    if (!*state)
        *state = malloc(tire_state_size(&self->tire));
    if (!*state)
        return fail(self, "no memory for a state");
    memcpy(*state, bytes, tire_state_size(&self->tire));
    return OK;
}

Status instance_derivatives(Instance *self, const Reference unknown[], size_t unknowns, const Reference known[],
                            size_t knowns, const double seed[], double x[])
{
    if (!given(self, unknown, unknowns, x) || !given(self, known, knowns, seed))
        return ERROR;
    for (size_t i = 0; i < knowns; i++)
        if (!isfinite(seed[i]))
            return fail(self, "the seed of value reference %u is not a finite number", known[i]);
    evaluate(self, false);
    for (size_t i = 0; i < unknowns; i++) {
        const int state = tire_state_variable(&self->tire, unknown[i]);
        double now;
        const bool computed = unknown[i] == RADIAL_FORCE || unknown[i] == RADIAL_STIFFNESS
                              || state >= self->tire.continuous_count
                              || (unknown[i] > tire_references(&self->tire) && tire_get(&self->tire, unknown[i], &now));
        if (!computed || !tire_derivative(&self->tire, unknown[i], known, seed, knowns, x + i))
            return fail(self, "there is no derivative of value reference %u by these variables", unknown[i]);
    }
    return OK;
}

/* Co-Simulation. */

Status instance_step_any(Instance *self, double time, double step)
{
    char trouble[TROUBLE];
    return tire_advance(&self->tire, time, step, trouble) ? OK : tell(self, ERROR, trouble);
}

/* Model Exchange. */

Status instance_set_time(Instance *self, double time)
{
    if (!isfinite(time))
        return fail(self, "time = %.17g s is not allowed; it must be a finite number", time);
    self->tire.m.time = time;
    self->tire.current = false;
    return OK;
}

/* Whether the number of values is that of the states. */
static bool fits(const Instance *self, const void *x, size_t n)
{
    if (n == (size_t)self->tire.continuous_count && (x || !n))
        return true;
    fail(self, "%u values were given for %d continuous states", (unsigned)n, self->tire.continuous_count);
    return false;
}

Status instance_set_states(Instance *self, const double x[], size_t n)
{
    if (!fits(self, x, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        self->tire.m.s[self->tire.continuous[i]] = x[i];
    self->tire.current = false;
    return OK;
}

Status instance_get_states(Instance *self, double x[], size_t n)
{
    if (!fits(self, x, n))
        return ERROR;
    if (stage(self) == INITIALIZATION) { /* they follow from the start's inputs */
        double rates[MOST_CONTINUOUS];
        evaluate(self, false);
        tire_flow(&self->tire, x, rates);
        return OK;
    }
    for (size_t i = 0; i < n; i++)
        x[i] = self->tire.m.s[self->tire.continuous[i]];
    return OK;
}

Status instance_get_rates(Instance *self, double x[], size_t n)
{
    if (!fits(self, x, n))
        return ERROR;
    const Status status = evaluate(self, stage(self) != INITIALIZATION);
    if (stage(self) == INITIALIZATION) {
        double states[MOST_CONTINUOUS];
        tire_flow(&self->tire, states, x);
        return status;
    }
    for (size_t i = 0; i < n; i++)
        x[i] = self->tire.n[self->tire.continuous[i]];
    return status;
}

Status instance_get_nominals(Instance *self, double x[], size_t n)
{
    if (!fits(self, x, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        x[i] = 1000;
    return OK;
}

Status instance_get_indicators(Instance *self, double x[], size_t n)
{
    if (n != 1 || !x)
        return fail(self, "%u values were given for one event indicator", (unsigned)n);
    const Status status = evaluate(self, true);
    x[0] = self->tire.compression; /* the contact begins and ends at 0 */
    return status;
}

/* The memory of friction, softening and delays is kept at the steps that the solver accepts. */
Status instance_accept(Instance *self)
{
    char trouble[TROUBLE];
    if (!tire_accept(&self->tire, self->tire.m.time, trouble))
        return tell(self, ERROR, trouble);
    self->tire.current = false;
    return OK;
}

/* An event's change of the inputs comes after the step that the solver has completed at its time. */
Status instance_enter_event(Instance *self)
{
    tire_settle(&self->tire);
    self->tire.m.stage = EVENT;
    return OK;
}
