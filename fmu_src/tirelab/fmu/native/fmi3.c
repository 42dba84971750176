/*
 * FMI 3.0, Co-Simulation and Model Exchange: the same tire, whose numbers are those of FMI 2.0 bit by bit.
 *
 * Which call is allowed in which state: sections 2.3, 3.2 and 4.2 of the standard 3.0. After an error the standard leaves
 * a reset or a saved state; a host that sets a good value instead may go on all the same, as with FMI 2.0.
 */
#include "instance.h"

#include <stdint.h>
#include <string.h>

enum {
    BEFORE = INSTANTIATED | INITIALIZATION,
    MAY_GET_3 = ANY,
    MAY_SET_3 = BEFORE | RUNNING,
    MAY_SET_DISCRETE_3 = BEFORE | STEP_COMPLETE | EVENT,
    MAY_DERIVE_3 = INITIALIZATION | RUNNING | TERMINATED,
    MAY_NUMBER_3 = OF_EXCHANGE | BEFORE | EVENT | CONTINUOUS | TERMINATED,
    MAY_NOMINALS_3 = OF_EXCHANGE | INITIALIZATION | EVENT | CONTINUOUS | TERMINATED
};

/* '#' is doubled: single ones enclose value references. */
static void teller(const Instance *self, Status status, String category, String text)
{
    void (*logger)(void *, Status, String, String) = (void (*)(void *, Status, String, String))self->logger;
    char message[2 * TROUBLE], *end = message;
    for (; *text && end < message + sizeof message - 2; *end++ = *text++)
        if (*text == '#')
            *end++ = '#';
    *end = 0;
    logger(self->environment, status, category, message);
}

typedef void (*Logger)(void *environment, Status, String category, String message);

static Instance *instantiated(String name, String token, String resources, bool exchange, bool logging, void *environment,
                              Logger logger, String refused)
{
    Instance how;
    memset(&how, 0, sizeof how);
    how.teller = teller;
    how.logger = (void (*)(void))logger;
    how.environment = environment;
    how.quiet = !logging;
    how.tire.exchange = exchange;
    how.tire.newer = true;
    if (!refused)
        return instance_new(how, name, token, resources);
    tell(&how, ERROR, refused);
    return NULL;
}

EXPORT String fmi3GetVersion(void) { return "3.0"; }

EXPORT void *fmi3InstantiateModelExchange(String name, String token, String resources, bool visible, bool logging,
                                          void *environment, Logger logger)
{
    (void)visible;
    return instantiated(name, token, resources, true, logging, environment, logger, NULL);
}

EXPORT void *fmi3InstantiateCoSimulation(String name, String token, String resources, bool visible, bool logging,
                                         bool event_mode, bool early_return, const Reference intermediate[], size_t n,
                                         void *environment, Logger logger, void (*update)(void))
{
    (void)visible, (void)early_return, (void)intermediate, (void)n, (void)update;
    return instantiated(name, token, resources, false, logging, environment, logger,
                        event_mode ? "eventModeUsed is true, but this FMU has no Event Mode in Co-Simulation" : NULL);
}

EXPORT void *fmi3InstantiateScheduledExecution(String name, String token, String resources, bool visible, bool logging,
                                               void *environment, Logger logger, void (*update)(void), void (*lock)(void),
                                               void (*unlock)(void))
{
    (void)visible, (void)update, (void)lock, (void)unlock;
    return instantiated(name, token, resources, false, logging, environment, logger,
                        "this FMU has no Scheduled Execution; use Co-Simulation or Model Exchange");
}

EXPORT void fmi3FreeInstance(void *c) { instance_free(c); }

EXPORT Status fmi3SetDebugLogging(void *c, bool on, size_t n, const String categories[])
{
    ENTER(ANY, "fmi3SetDebugLogging")
    if (n && !categories)
        return fail(self, "the categories are NULL");
    if (!n)
        self->quiet = !on;
    for (size_t i = 0; i < n; i++) /* errors are told whatever the host says */
        if (categories[i] && !strcmp(categories[i], "logStatusDiscard"))
            self->quiet = !on;
    return OK;
}

EXPORT Status fmi3EnterInitializationMode(void *c, bool has_tolerance, double tolerance, double start, bool has_stop,
                                          double stop)
{
    (void)has_tolerance, (void)tolerance;
    ENTER(INSTANTIATED, "fmi3EnterInitializationMode")
    const Status status = instance_start_at(self, start, has_stop, stop);
    if (status == OK)
        self->tire.m.stage = INITIALIZATION;
    return status;
}

EXPORT Status fmi3ExitInitializationMode(void *c)
{
    ENTER(INITIALIZATION, "fmi3ExitInitializationMode")
    return instance_begin(self);
}

#define CHANGE(Name, states, next) \
    EXPORT Status fmi3##Name(void *c) \
    { \
        ENTER(states, "fmi3" #Name) \
        self->tire.m.stage = next; \
        return OK; \
    }
CHANGE(Terminate, RUNNING, TERMINATED)
CHANGE(EnterContinuousTimeMode, EVENT, CONTINUOUS)

EXPORT Status fmi3Reset(void *c)
{
    ENTER(ANY, "fmi3Reset")
    tire_reset(&self->tire);
    return OK;
}

/* Variables: those of FMI 2.0; after them time and the deflection whose sign tells of contact. */

static bool fits(const Instance *self, size_t n, size_t values)
{
    if (n != values)
        fail(self, "%u values for %u variables, each of which has one", (unsigned)values, (unsigned)n);
    return n == values;
}

EXPORT Status fmi3GetFloat64(void *c, const Reference v[], size_t n, double x[], size_t values)
{
    Status status = OK;
    ENTER(MAY_GET_3, "fmi3GetFloat64")
    if (!fits(self, n, values) || !given(self, v, n, x))
        return ERROR;
    const Reference time = tire_references(&self->tire);
    for (size_t i = 0; i < n && status <= DISCARD; i++) {
        const Status one = v[i] == time ? OK : instance_get_reals(self, v + i, 1, x + i);
        if (v[i] == time)
            x[i] = self->tire.m.time;
        status = one > status ? one : status;
    }
    return status;
}

EXPORT Status fmi3SetFloat64(void *c, const Reference v[], size_t n, const double x[], size_t values)
{
    ENTER(MAY_SET_3, "fmi3SetFloat64")
    return fits(self, n, values) ? instance_set_reals(self, v, n, x) : ERROR;
}

EXPORT Status fmi3GetBoolean(void *c, const Reference v[], size_t n, bool x[], size_t values)
{
    Status status = OK;
    ENTER(MAY_GET_3, "fmi3GetBoolean")
    if (!fits(self, n, values) || !given(self, v, n, x))
        return ERROR;
    for (size_t i = 0; i < n && status == OK; i++)
        status = instance_get_boolean(self, v[i], x + i);
    return status;
}

EXPORT Status fmi3SetBoolean(void *c, const Reference v[], size_t n, const bool x[], size_t values)
{
    ENTER(MAY_SET_DISCRETE_3, "fmi3SetBoolean")
    if (!fits(self, n, values) || !given(self, v, n, x) || !instance_has_booleans(self, v, n))
        return ERROR;
    for (size_t i = 0; i < n; i++)
        tire_give_motion(&self->tire, x[i]);
    return OK;
}

/* There are no variables of these types, whatever the arguments after their number. */
static Status none(Instance *self, const Reference v[], size_t n, int states, String function)
{
    if (!allowed(self, states, function))
        return ERROR;
    return n ? fail(self, "value reference %u is no variable for %s", v ? v[0] : 0, function) : OK;
}

#define NONE(Name) \
    EXPORT Status fmi3Get##Name(void *c, const Reference v[], size_t n) { return none(c, v, n, MAY_GET_3, "fmi3Get" #Name); } \
    EXPORT Status fmi3Set##Name(void *c, const Reference v[], size_t n) \
    { \
        return none(c, v, n, MAY_SET_DISCRETE_3, "fmi3Set" #Name); \
    }
NONE(Float32)
NONE(Int8)
NONE(UInt8)
NONE(Int16)
NONE(UInt16)
NONE(Int32)
NONE(UInt32)
NONE(Int64)
NONE(UInt64)
NONE(String)
NONE(Binary)
NONE(Clock)

/* What the model description says that this FMU does not have, whatever the arguments. */
static Status unsupported(const Instance *self, String function)
{
    return self ? fail(self, "%s is not supported", function) : ERROR;
}

#define UNSUPPORTED(Name) \
    EXPORT Status fmi3##Name(void *c) { return unsupported(c, "fmi3" #Name); }
UNSUPPORTED(GetNumberOfVariableDependencies)
UNSUPPORTED(GetVariableDependencies)
UNSUPPORTED(GetAdjointDerivative)
UNSUPPORTED(EnterConfigurationMode)
UNSUPPORTED(ExitConfigurationMode)
UNSUPPORTED(GetIntervalDecimal)
UNSUPPORTED(GetIntervalFraction)
UNSUPPORTED(GetShiftDecimal)
UNSUPPORTED(GetShiftFraction)
UNSUPPORTED(SetIntervalDecimal)
UNSUPPORTED(SetIntervalFraction)
UNSUPPORTED(SetShiftDecimal)
UNSUPPORTED(SetShiftFraction)
UNSUPPORTED(EvaluateDiscreteStates)
UNSUPPORTED(EnterStepMode)
UNSUPPORTED(GetOutputDerivatives)
UNSUPPORTED(ActivateModelPartition)

/* States of the FMU. */

EXPORT Status fmi3GetFMUState(void *c, void **state)
{
    ENTER(ANY, "fmi3GetFMUState")
    return instance_save(self, state);
}

EXPORT Status fmi3SetFMUState(void *c, void *state)
{
    ENTER(ANY, "fmi3SetFMUState")
    return instance_restore(self, state);
}

EXPORT Status fmi3FreeFMUState(void *c, void **state)
{
    ENTER(ANY, "fmi3FreeFMUState")
    return instance_forget(state);
}

EXPORT Status fmi3SerializedFMUStateSize(void *c, void *state, size_t *size)
{
    (void)state;
    ENTER(ANY, "fmi3SerializedFMUStateSize")
    return instance_state_size(self, size);
}

EXPORT Status fmi3SerializeFMUState(void *c, void *state, uint8_t bytes[], size_t size)
{
    ENTER(ANY, "fmi3SerializeFMUState")
    return instance_write(self, state, (char *)bytes, size);
}

EXPORT Status fmi3DeserializeFMUState(void *c, const uint8_t bytes[], size_t size, void **state)
{
    ENTER(ANY, "fmi3DeserializeFMUState")
    return instance_read(self, (const char *)bytes, size, state);
}

EXPORT Status fmi3GetDirectionalDerivative(void *c, const Reference unknown[], size_t unknowns, const Reference known[],
                                           size_t knowns, const double seed[], size_t seeds, double x[], size_t values)
{
    ENTER(MAY_DERIVE_3, "fmi3GetDirectionalDerivative")
    if (!fits(self, unknowns, values) || !fits(self, knowns, seeds))
        return ERROR;
    return instance_derivatives(self, unknown, unknowns, known, knowns, seed, x);
}

/* Co-Simulation. */

EXPORT Status fmi3DoStep(void *c, double time, double step, bool no_rewind, bool *event, bool *terminate, bool *early,
                         double *reached)
{
    (void)no_rewind;
    ENTER(STEP_COMPLETE, "fmi3DoStep")
    if (!event || !terminate || !early || !reached)
        return fail(self, "the place for the answer is NULL");
    *event = *terminate = *early = false;
    const Status status = instance_step(self, time, step);
    *reached = self->tire.m.reached;
    return status;
}

/* Model Exchange. */

EXPORT Status fmi3UpdateDiscreteStates(void *c, bool *again, bool *terminate, bool *nominals, bool *values, bool *next,
                                       double *next_time)
{
    ENTER(EVENT, "fmi3UpdateDiscreteStates")
    if (!again || !terminate || !nominals || !values || !next || !next_time)
        return fail(self, "the place for the event information is NULL");
    *again = *terminate = *nominals = *values = *next = false;
    *next_time = 0;
    return OK;
}

EXPORT Status fmi3CompletedIntegratorStep(void *c, bool no_rewind, bool *event, bool *terminate)
{
    (void)no_rewind;
    ENTER(CONTINUOUS, "fmi3CompletedIntegratorStep")
    if (!event || !terminate)
        return fail(self, "the place for the answer is NULL");
    *event = *terminate = false;
    return instance_accept(self);
}

EXPORT Status fmi3EnterEventMode(void *c)
{
    ENTER(CONTINUOUS, "fmi3EnterEventMode")
    return instance_enter_event(self);
}

EXPORT Status fmi3SetTime(void *c, double time)
{
    ENTER(EVENT | CONTINUOUS, "fmi3SetTime")
    return instance_set_time(self, time);
}

#define STATES_OF(Name, states, type, call) \
    EXPORT Status fmi3##Name(void *c, type x[], size_t n) \
    { \
        ENTER(states, "fmi3" #Name) \
        return instance_##call(self, x, n); \
    }
STATES_OF(SetContinuousStates, CONTINUOUS, const double, set_states)
STATES_OF(GetContinuousStates, MAY_NOMINALS_3, double, get_states)
STATES_OF(GetContinuousStateDerivatives, MAY_NOMINALS_3, double, get_rates)
STATES_OF(GetNominalsOfContinuousStates, MAY_NOMINALS_3, double, get_nominals)

/* The variable contact_deflection, whose nominal value says of which order it is. */
EXPORT Status fmi3GetEventIndicators(void *c, double x[], size_t n)
{
    ENTER(MAY_NOMINALS_3, "fmi3GetEventIndicators")
    return instance_get_indicators(self, x, n);
}

#define NUMBER_OF(Name, value) \
    EXPORT Status fmi3GetNumberOf##Name(void *c, size_t *n) \
    { \
        ENTER(MAY_NUMBER_3, "fmi3GetNumberOf" #Name) \
        if (!n) \
            return fail(self, "the place for the number is NULL"); \
        *n = value; \
        return OK; \
    }
NUMBER_OF(ContinuousStates, (size_t)self->tire.continuous_count)
NUMBER_OF(EventIndicators, 1)
