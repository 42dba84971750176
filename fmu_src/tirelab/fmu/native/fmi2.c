/* FMI 2.0, Co-Simulation and Model Exchange, around a tire. */
#include "fmi2.h"
#include "tire.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef struct {
    int new_discrete_states_needed, terminate, nominals_changed, values_changed, next_event_time_defined;
    double next_event_time;
} EventInfo;

typedef struct {
    Tire tire;
    Callbacks host;
    char *name;
} Instance;

/* Hands a message to the host: '%' doubled, as the host reads a printf format. */
static Status tell(const Instance *self, Status status, const char *text)
{
    static const char *const categories[] = {"logAll", "logStatusWarning", "logStatusDiscard", "logStatusError",
                                             "logStatusFatal", "logAll"};
    char format[2 * TROUBLE], *end = format;
    for (; *text && end < format + sizeof format - 2; *end++ = *text++)
        if (*text == '%')
            *end++ = '%';
    *end = 0;
    if (self->host.logger)
        self->host.logger(self->host.environment, self->name, status, categories[status], format);
    return status;
}

__attribute__((format(printf, 2, 3))) static Status fail(const Instance *self, const char *format, ...)
{
    char text[TROUBLE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return tell(self, ERROR, text);
}

static State stage(const Instance *self) { return (State)self->tire.m.stage; }

static bool allowed(const Instance *self, int states, const char *function)
{
    if (!self || stage(self) & states)
        return self != NULL;
    fail(self, "fmi2%s is not allowed in the state \"%s\"", function, state_name(stage(self)));
    return false;
}

/* The frame of every function of an instance. */
#define ENTER(states, function) \
    Instance *self = c; \
    if (!allowed(self, states, function)) \
        return ERROR;

/* Values for the inputs as they are now; a message only where `heard`: in co-simulation the step has one. */
static Status evaluate(Instance *self, bool heard)
{
    char trouble[TROUBLE];
    if (self->tire.current && (!heard || isfinite(self->tire.force)))
        return OK;
    return tire_try(&self->tire, self->tire.m.time, trouble) || !heard ? OK : tell(self, DISCARD, trouble);
}

EXPORT String fmi2GetTypesPlatform(void) { return "default"; }
EXPORT String fmi2GetVersion(void) { return "2.0"; }

EXPORT void *fmi2Instantiate(String name, int type, String guid, String location, const Callbacks *host, int visible,
                             int logging)
{
    char trouble[TROUBLE];
    (void)visible, (void)logging; /* the messages are few: all of them are told */
    Instance *self = host ? calloc(1, sizeof *self) : NULL;
    if (!self)
        return NULL;
    self->host = *host;
    self->tire.exchange = type == MODEL_EXCHANGE;
    const size_t length = strlen(name ? name : "") + 1;
    self->name = malloc(length);
    if (self->name) {
        memcpy(self->name, name ? name : "", length);
        if (tire_read(&self->tire, location, guid, trouble)) {
            tire_reset(&self->tire);
            return self;
        }
        tell(self, ERROR, trouble);
    }
    tire_free(&self->tire);
    free(self->name);
    free(self);
    return NULL;
}

EXPORT void fmi2FreeInstance(void *c)
{
    Instance *self = c;
    if (!self)
        return;
    tire_free(&self->tire);
    free(self->name);
    free(self);
}

EXPORT Status fmi2SetDebugLogging(void *c, int on, size_t n, const String categories[])
{
    (void)on, (void)n, (void)categories;
    ENTER(MAY_SetDebugLogging, "SetDebugLogging")
    return OK;
}

EXPORT Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop, double stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    ENTER(MAY_SetupExperiment, "SetupExperiment")
    if (!isfinite(start))
        return fail(self, "startTime = %.17g s is not allowed; it must be a finite number", start);
    self->tire.m.time = self->tire.m.reached = start;
    return OK;
}

EXPORT Status fmi2EnterInitializationMode(void *c)
{
    ENTER(MAY_EnterInitializationMode, "EnterInitializationMode")
    self->tire.m.stage = INITIALIZATION;
    return OK;
}

EXPORT Status fmi2ExitInitializationMode(void *c)
{
    char trouble[TROUBLE];
    ENTER(MAY_ExitInitializationMode, "ExitInitializationMode")
    if (!tire_begin(&self->tire, self->tire.m.reached, trouble))
        return tell(self, ERROR, trouble);
    self->tire.m.stage = self->tire.exchange ? EVENT : STEP_COMPLETE;
    self->tire.current = false;
    return OK;
}

EXPORT Status fmi2Terminate(void *c)
{
    ENTER(MAY_Terminate, "Terminate")
    self->tire.m.stage = TERMINATED;
    return OK;
}

EXPORT Status fmi2Reset(void *c)
{
    ENTER(MAY_Reset, "Reset")
    tire_reset(&self->tire);
    return OK;
}

/* Variables. */

static bool given(const Instance *self, const void *references, size_t n, const void *values)
{
    if (!n || (references && values))
        return true;
    fail(self, "references or values are NULL");
    return false;
}

EXPORT Status fmi2GetReal(void *c, const Reference v[], size_t n, double x[])
{
    ENTER(MAY_Get, "GetReal")
    if (!given(self, v, n, x))
        return ERROR;
    Status status = evaluate(self, self->tire.exchange && stage(self) != INITIALIZATION);
    for (size_t i = 0; i < n; i++)
        if (v[i] == RADIAL_FORCE)
            x[i] = self->tire.force;
        else if (!tire_get(&self->tire, v[i], x + i))
            return fail(self, "value reference %u is no Real variable of this tire", v[i]);
    return status;
}

EXPORT Status fmi2SetReal(void *c, const Reference v[], size_t n, const double x[])
{
    ENTER(MAY_SetReal, "SetReal")
    if (!given(self, v, n, x))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        if (v[i] > SURFACE_RADIUS && !tire_can_set(&self->tire, v[i]))
            return v[i] == RADIAL_FORCE || v[i] == RADIAL_STIFFNESS
                       ? fail(self, "%s = %.17g cannot be set; set inputs and parameters only",
                              v[i] == RADIAL_FORCE ? "radial_force" : "radial_stiffness", x[i])
                       : fail(self, "value reference %u = %.17g cannot be set; set inputs and parameters only", v[i], x[i]);
    for (size_t i = 0; i < n; i++)
        tire_set(&self->tire, v[i], x[i]);
    return OK;
}

EXPORT Status fmi2GetBoolean(void *c, const Reference v[], size_t n, int x[])
{
    ENTER(MAY_Get, "GetBoolean")
    if (!given(self, v, n, x))
        return ERROR;
    evaluate(self, false);
    for (size_t i = 0; i < n; i++)
        if (v[i] == IN_TESTED_RANGE)
            x[i] = tire_in_range(&self->tire);
        else if (tire_is_motion_given(&self->tire, v[i]))
            x[i] = self->tire.m.given != 0;
        else
            return fail(self, "value reference %u is no Boolean variable of this tire", v[i]);
    return OK;
}

EXPORT Status fmi2SetBoolean(void *c, const Reference v[], size_t n, const int x[])
{
    ENTER(MAY_Set, "SetBoolean")
    if (!given(self, v, n, x))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        if (!tire_is_motion_given(&self->tire, v[i]))
            return fail(self, "value reference %u cannot be set as a Boolean; set motion_given only", v[i]);
    for (size_t i = 0; i < n; i++)
        tire_give_motion(&self->tire, x[i] != 0);
    return OK;
}

/* There are no variables of these types. */
#define NONE(Verb, Name, type, states) \
    EXPORT Status fmi2##Verb##Name(void *c, const Reference v[], size_t n, type x[]) \
    { \
        (void)x; \
        ENTER(states, #Verb #Name) \
        return n ? fail(self, "value reference %u is no " #Name " variable of this tire", v ? v[0] : 0) : OK; \
    }
NONE(Get, Integer, int, MAY_Get)
NONE(Set, Integer, const int, MAY_Set)
NONE(Get, String, String, MAY_Get)
NONE(Set, String, const String, MAY_Set)

/* States of the FMU: the bytes that they are written as. */

EXPORT Status fmi2GetFMUstate(void *c, void **state)
{
    ENTER(MAY_FMUstate, "GetFMUstate")
    if (!state)
        return fail(self, "the place for the state is NULL");
    if (!*state)
        *state = malloc(tire_state_size(&self->tire));
    if (!*state)
        return fail(self, "no memory for a state");
    tire_save(&self->tire, *state);
    return OK;
}

EXPORT Status fmi2SetFMUstate(void *c, void *state)
{
    char trouble[TROUBLE];
    ENTER(MAY_FMUstate, "SetFMUstate")
    if (!state)
        return fail(self, "the state is NULL");
    return tire_restore(&self->tire, state, tire_state_size(&self->tire), trouble) ? OK : tell(self, ERROR, trouble);
}

EXPORT Status fmi2FreeFMUstate(void *c, void **state)
{
    ENTER(MAY_FMUstate, "FreeFMUstate")
    if (state) {
        free(*state);
        *state = NULL;
    }
    return OK;
}

EXPORT Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size)
{
    (void)state;
    ENTER(MAY_FMUstate, "SerializedFMUstateSize")
    if (!size)
        return fail(self, "the place for the size is NULL");
    *size = tire_state_size(&self->tire);
    return OK;
}

EXPORT Status fmi2SerializeFMUstate(void *c, void *state, char bytes[], size_t size)
{
    ENTER(MAY_FMUstate, "SerializeFMUstate")
    if (!state || !bytes || size < tire_state_size(&self->tire))
        return fail(self, "the place for the bytes of a state is NULL or too small");
    memcpy(bytes, state, tire_state_size(&self->tire));
    return OK;
}

EXPORT Status fmi2DeSerializeFMUstate(void *c, const char bytes[], size_t size, void **state)
{
    char trouble[TROUBLE];
    ENTER(MAY_FMUstate, "DeSerializeFMUstate")
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

EXPORT Status fmi2GetDirectionalDerivative(void *c, const Reference unknown[], size_t unknowns, const Reference known[],
                                           size_t knowns, const double seed[], double x[])
{
    ENTER(MAY_GetDirectionalDerivative, "GetDirectionalDerivative")
    if (!given(self, unknown, unknowns, x) || !given(self, known, knowns, seed))
        return ERROR;
    evaluate(self, false);
    for (size_t i = 0; i < unknowns; i++) {
        const int state = tire_state_variable(&self->tire, unknown[i]);
        if ((unknown[i] != RADIAL_FORCE && state < self->tire.continuous_count)
            || !tire_derivative(&self->tire, unknown[i], known, seed, knowns, x + i))
            return fail(self, "there is no derivative of value reference %u by these variables", unknown[i]);
    }
    return OK;
}

/* Co-Simulation. */

EXPORT Status fmi2DoStep(void *c, double time, double step, int no_rewind)
{
    char trouble[TROUBLE];
    (void)no_rewind;
    ENTER(MAY_DoStep, "DoStep")
    if (tire_step_fits(&self->tire, time, step, trouble) && tire_accept(&self->tire, time + step, trouble))
        return OK;
    return tell(self, ERROR, trouble);
}

#define UNSUPPORTED(Name, states) /* whatever its other arguments */ \
    EXPORT Status fmi2##Name(void *c) \
    { \
        ENTER(states, #Name) \
        return fail(self, "fmi2" #Name " is not supported"); \
    }
UNSUPPORTED(SetRealInputDerivatives, MAY_SetRealInputDerivatives)
UNSUPPORTED(GetRealOutputDerivatives, MAY_GetRealOutputDerivatives)
UNSUPPORTED(CancelStep, MAY_CancelStep)

#define GET_STATUS(Name, type, known, value) \
    EXPORT Status fmi2Get##Name##Status(void *c, int kind, type *x) \
    { \
        ENTER(MAY_GetStatus, "Get" #Name "Status") \
        if (kind != (known) || !x) \
            return DISCARD; \
        *x = value; \
        return OK; \
    }
GET_STATUS(, Status, -1, OK) /* none of these can be retrieved: fmi2Discard */
GET_STATUS(Integer, int, -1, 0)
GET_STATUS(String, String, -1, "")
GET_STATUS(Real, double, LAST_SUCCESSFUL_TIME, self->tire.m.reached)
GET_STATUS(Boolean, int, HAS_TERMINATED, 0)

/* Model Exchange. */

EXPORT Status fmi2EnterEventMode(void *c)
{
    ENTER(MAY_EnterEventMode, "EnterEventMode")
    self->tire.m.stage = EVENT;
    return OK;
}

EXPORT Status fmi2NewDiscreteStates(void *c, EventInfo *info)
{
    static const EventInfo nothing;
    ENTER(MAY_NewDiscreteStates, "NewDiscreteStates")
    if (!info)
        return fail(self, "the place for the event information is NULL");
    *info = nothing;
    return OK;
}

EXPORT Status fmi2EnterContinuousTimeMode(void *c)
{
    ENTER(MAY_EnterContinuousTimeMode, "EnterContinuousTimeMode")
    self->tire.m.stage = CONTINUOUS;
    return OK;
}

/* The memory of friction, softening and delays is kept at the steps that the solver accepts. */
EXPORT Status fmi2CompletedIntegratorStep(void *c, int no_rewind, int *event, int *terminate)
{
    char trouble[TROUBLE];
    (void)no_rewind;
    ENTER(MAY_CompletedIntegratorStep, "CompletedIntegratorStep")
    if (!event || !terminate)
        return fail(self, "the place for the answer is NULL");
    *event = *terminate = 0;
    if (!tire_accept(&self->tire, self->tire.m.time, trouble))
        return tell(self, ERROR, trouble);
    self->tire.current = false;
    return OK;
}

EXPORT Status fmi2SetTime(void *c, double time)
{
    ENTER(MAY_SetTime, "SetTime")
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

EXPORT Status fmi2SetContinuousStates(void *c, const double x[], size_t n)
{
    ENTER(MAY_SetContinuousStates, "SetContinuousStates")
    if (!fits(self, x, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        self->tire.m.s[self->tire.continuous[i]] = x[i];
    self->tire.current = false;
    return OK;
}

EXPORT Status fmi2GetContinuousStates(void *c, double x[], size_t n)
{
    ENTER(MAY_GetContinuous, "GetContinuousStates")
    if (!fits(self, x, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        x[i] = self->tire.m.s[self->tire.continuous[i]];
    return OK;
}

EXPORT Status fmi2GetDerivatives(void *c, double x[], size_t n)
{
    ENTER(MAY_GetContinuous, "GetDerivatives")
    if (!fits(self, x, n))
        return ERROR;
    const Status status = evaluate(self, true);
    for (size_t i = 0; i < n; i++)
        x[i] = self->tire.bare ? 0 : self->tire.n[self->tire.continuous[i]];
    return status;
}

EXPORT Status fmi2GetEventIndicators(void *c, double x[], size_t n)
{
    ENTER(MAY_GetContinuous, "GetEventIndicators")
    if (n != 1 || !x)
        return fail(self, "%u values were given for one event indicator", (unsigned)n);
    const Status status = evaluate(self, true);
    x[0] = self->tire.compression; /* the contact begins and ends at 0 */
    return status;
}

EXPORT Status fmi2GetNominalsOfContinuousStates(void *c, double x[], size_t n)
{
    ENTER(MAY_GetNominalsOfContinuousStates, "GetNominalsOfContinuousStates")
    if (!fits(self, x, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        x[i] = 1000;
    return OK;
}
