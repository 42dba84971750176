/* FMI 2.0, Co-Simulation and Model Exchange. */
#include "instance.h"

#include <string.h>

typedef struct {
    int new_discrete_states_needed, terminate, nominals_changed, values_changed, next_event_time_defined;
    double next_event_time;
} EventInfo;

/* '%' is doubled, as the host reads a printf format. */
static void teller(const Instance *self, Status status, String category, String text)
{
    void (*logger)(void *, String, Status, String, String, ...) =
        (void (*)(void *, String, Status, String, String, ...))self->logger;
    char format[2 * TROUBLE], *end = format;
    for (; *text && end < format + sizeof format - 2; *end++ = *text++)
        if (*text == '%')
            *end++ = '%';
    *end = 0;
    logger(self->environment, self->name, status, category, format);
}

EXPORT String fmi2GetTypesPlatform(void) { return "default"; }
EXPORT String fmi2GetVersion(void) { return "2.0"; }

EXPORT void *fmi2Instantiate(String name, int type, String guid, String location, const Callbacks *host, int visible,
                             int logging)
{
    Instance how;
    (void)visible, (void)logging; /* the messages are few: all of them are told */
    if (!host)
        return NULL;
    memset(&how, 0, sizeof how);
    how.teller = teller;
    how.logger = (void (*)(void))host->logger;
    how.environment = host->environment;
    how.tire.exchange = type == MODEL_EXCHANGE;
    return instance_new(how, name, guid, location);
}

EXPORT void fmi2FreeInstance(void *c) { instance_free(c); }

EXPORT Status fmi2SetDebugLogging(void *c, int on, size_t n, const String categories[])
{
    (void)on, (void)n, (void)categories;
    ENTER(MAY_SetDebugLogging, "fmi2SetDebugLogging")
    return OK;
}

EXPORT Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop, double stop)
{
    (void)has_tolerance, (void)tolerance;
    ENTER(MAY_SetupExperiment, "fmi2SetupExperiment")
    return instance_start_at(self, start, has_stop != 0, stop);
}

#define CHANGE(Name, next) \
    EXPORT Status fmi2##Name(void *c) \
    { \
        ENTER(MAY_##Name, "fmi2" #Name) \
        self->tire.m.stage = next; \
        return OK; \
    }
CHANGE(EnterInitializationMode, INITIALIZATION)
CHANGE(Terminate, TERMINATED)
CHANGE(EnterContinuousTimeMode, CONTINUOUS)

EXPORT Status fmi2ExitInitializationMode(void *c)
{
    ENTER(MAY_ExitInitializationMode, "fmi2ExitInitializationMode")
    return instance_begin(self);
}

EXPORT Status fmi2Reset(void *c)
{
    ENTER(MAY_Reset, "fmi2Reset")
    tire_reset(&self->tire);
    return OK;
}

/* Variables. */

EXPORT Status fmi2GetReal(void *c, const Reference v[], size_t n, double x[])
{
    ENTER(MAY_Get, "fmi2GetReal")
    return instance_get_reals(self, v, n, x);
}

EXPORT Status fmi2SetReal(void *c, const Reference v[], size_t n, const double x[])
{
    ENTER(MAY_SetReal, "fmi2SetReal")
    return instance_set_reals(self, v, n, x);
}

EXPORT Status fmi2GetBoolean(void *c, const Reference v[], size_t n, int x[])
{
    Status status = OK;
    ENTER(MAY_Get, "fmi2GetBoolean")
    if (!given(self, v, n, x))
        return ERROR;
    for (size_t i = 0; i < n && status == OK; i++) {
        bool value = false;
        status = instance_get_boolean(self, v[i], &value);
        x[i] = value;
    }
    return status;
}

EXPORT Status fmi2SetBoolean(void *c, const Reference v[], size_t n, const int x[])
{
    ENTER(MAY_Set, "fmi2SetBoolean")
    if (!given(self, v, n, x) || !instance_has_booleans(self, v, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        tire_give_motion(&self->tire, x[i] != 0);
    return OK;
}

/* There are no variables of these types. */
#define NONE(Verb, Name, type, states) \
    EXPORT Status fmi2##Verb##Name(void *c, const Reference v[], size_t n, type x[]) \
    { \
        (void)x; \
        ENTER(states, "fmi2" #Verb #Name) \
        return n ? fail(self, "value reference %u is no " #Name " variable of this tire", v ? v[0] : 0) : OK; \
    }
NONE(Get, Integer, int, MAY_Get)
NONE(Set, Integer, const int, MAY_Set)
NONE(Get, String, String, MAY_Get)
NONE(Set, String, const String, MAY_Set)

/* States of the FMU. */

EXPORT Status fmi2GetFMUstate(void *c, void **state)
{
    ENTER(MAY_FMUstate, "fmi2GetFMUstate")
    return instance_save(self, state);
}

EXPORT Status fmi2SetFMUstate(void *c, void *state)
{
    ENTER(MAY_FMUstate, "fmi2SetFMUstate")
    return instance_restore(self, state);
}

EXPORT Status fmi2FreeFMUstate(void *c, void **state)
{
    ENTER(MAY_FMUstate, "fmi2FreeFMUstate")
    return instance_forget(state);
}

EXPORT Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size)
{
    (void)state;
    ENTER(MAY_FMUstate, "fmi2SerializedFMUstateSize")
    return instance_state_size(self, size);
}

EXPORT Status fmi2SerializeFMUstate(void *c, void *state, char bytes[], size_t size)
{
    ENTER(MAY_FMUstate, "fmi2SerializeFMUstate")
    return instance_write(self, state, bytes, size);
}

EXPORT Status fmi2DeSerializeFMUstate(void *c, const char bytes[], size_t size, void **state)
{
    ENTER(MAY_FMUstate, "fmi2DeSerializeFMUstate")
    return instance_read(self, bytes, size, state);
}

EXPORT Status fmi2GetDirectionalDerivative(void *c, const Reference unknown[], size_t unknowns, const Reference known[],
                                           size_t knowns, const double seed[], double x[])
{
    ENTER(MAY_GetDirectionalDerivative, "fmi2GetDirectionalDerivative")
    return instance_derivatives(self, unknown, unknowns, known, knowns, seed, x);
}

/* Co-Simulation. */

EXPORT Status fmi2DoStep(void *c, double time, double step, int no_rewind)
{
    (void)no_rewind;
    ENTER(MAY_DoStep, "fmi2DoStep")
    return instance_step(self, time, step);
}

#define UNSUPPORTED(Name) /* whatever its other arguments */ \
    EXPORT Status fmi2##Name(void *c) \
    { \
        ENTER(MAY_##Name, "fmi2" #Name) \
        return fail(self, "fmi2" #Name " is not supported"); \
    }
UNSUPPORTED(SetRealInputDerivatives)
UNSUPPORTED(GetRealOutputDerivatives)
UNSUPPORTED(CancelStep)

#define GET_STATUS(Name, type, known, value) \
    EXPORT Status fmi2Get##Name##Status(void *c, int kind, type *x) \
    { \
        ENTER(MAY_GetStatus, "fmi2Get" #Name "Status") \
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
    ENTER(MAY_EnterEventMode, "fmi2EnterEventMode")
    return instance_enter_event(self);
}

EXPORT Status fmi2NewDiscreteStates(void *c, EventInfo *info)
{
    static const EventInfo nothing;
    ENTER(MAY_NewDiscreteStates, "fmi2NewDiscreteStates")
    if (!info)
        return fail(self, "the place for the event information is NULL");
    *info = nothing;
    return OK;
}

EXPORT Status fmi2CompletedIntegratorStep(void *c, int no_rewind, int *event, int *terminate)
{
    (void)no_rewind;
    ENTER(MAY_CompletedIntegratorStep, "fmi2CompletedIntegratorStep")
    if (!event || !terminate)
        return fail(self, "the place for the answer is NULL");
    *event = *terminate = 0;
    return instance_accept(self);
}

EXPORT Status fmi2SetTime(void *c, double time)
{
    ENTER(MAY_SetTime, "fmi2SetTime")
    return instance_set_time(self, time);
}

#define STATES_OF(Name, states, type, call) \
    EXPORT Status fmi2##Name(void *c, type x[], size_t n) \
    { \
        ENTER(states, "fmi2" #Name) \
        return instance_##call(self, x, n); \
    }
STATES_OF(SetContinuousStates, MAY_SetContinuousStates, const double, set_states)
STATES_OF(GetContinuousStates, MAY_GetContinuous, double, get_states)
STATES_OF(GetDerivatives, MAY_GetContinuous, double, get_rates)
STATES_OF(GetNominalsOfContinuousStates, MAY_GetNominalsOfContinuousStates, double, get_nominals)

/* In centimetres, and never 0: the standard wants indicators of the order of one that tell their sign at each event. */
EXPORT Status fmi2GetEventIndicators(void *c, double x[], size_t n)
{
    ENTER(MAY_GetContinuous, "fmi2GetEventIndicators")
    double deflection;
    const Status status = instance_get_indicators(self, &deflection, x ? n : 0);
    if (status < ERROR)
        x[0] = deflection != 0 ? deflection / 0.01 : -1e-10;
    return status;
}
