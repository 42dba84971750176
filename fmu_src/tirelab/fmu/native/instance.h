/* An instance of the FMU for any version of FMI: a tire, the host's logger, and what the calls of both versions do. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "fmi2.h" /* its Status, Reference and String; FMI 3.0 has the same */
#include "tire.h"

typedef struct Instance Instance;

/* Hands a message to the host's logger. */
typedef void Teller(const Instance *, Status, String category, String text);

struct Instance {
    Tire tire;
    Teller *teller;
    void (*logger)(void);
    void *environment;
    char *name;
    bool quiet; /* discarded calls are not told */
};

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* The frame of every function of an instance: it is there, and the call is allowed in its state. */
#define ENTER(states, function) \
    Instance *self = c; \
    if (!allowed(self, states, function)) \
        return ERROR;

/* What is seldom called: kept out of the functions of every step, which then save no registers. */
#define SELDOM __attribute__((noinline, cold))

/* A message where a call is not allowed; false. */
SELDOM bool not_allowed(const Instance *, String function);

static inline bool allowed(const Instance *self, int states, String function)
{
    const int other = self && self->tire.exchange ? OF_STEPS : OF_EXCHANGE;
    return self && ((self->tire.m.stage & states && !(states & other)) || not_allowed(self, function));
}

/* Tell the host of a status; the status. */
SELDOM Status tell(const Instance *, Status, String text);
SELDOM __attribute__((format(printf, 2, 3))) Status fail(const Instance *, String format, ...);

/* A new instance like `how`, with a tire read from its data; NULL and a message where that cannot be done. */
Instance *instance_new(Instance how, String name, String guid, String resources);
void instance_free(Instance *);

Status instance_start_at(Instance *, double start, bool has_stop, double stop);
Status instance_begin(Instance *);

/* Any Real variables. */
__attribute__((noinline)) Status instance_get_any(Instance *, const Reference v[], size_t n, double x[]);
__attribute__((noinline)) Status instance_set_any(Instance *, const Reference v[], size_t n, const double x[]);

/* Real variables; the force, as it is asked for in every step, at once. */
static inline Status instance_get_reals(Instance *self, const Reference v[], size_t n, double x[])
{
    if (n != 1 || !v || !x || *v != RADIAL_FORCE || !self->tire.current || !isfinite(self->tire.force))
        return instance_get_any(self, v, n, x);
    *x = self->tire.force;
    return OK;
}

/* Real variables; deflection and radius, as they are set in every step, at once. */
static inline Status instance_set_reals(Instance *self, const Reference v[], size_t n, const double x[])
{
    if (n != 2 || !v || !x || v[0] != DEFLECTION || v[1] != SURFACE_RADIUS)
        return instance_set_any(self, v, n, x);
    self->tire.m.inputs.deflection = x[0];
    self->tire.m.inputs.radius = x[1];
    self->tire.current = false;
    return OK;
}

Status instance_get_boolean(Instance *, Reference v, bool *x);

/* Whether these are Boolean parameters (there is one); a message where one is not. */
bool instance_has_booleans(Instance *, const Reference v[], size_t n);

/* Whether there are references and values; a message where one of them is missing. */
bool given(const Instance *, const void *references, size_t n, const void *values);

/* States of the FMU: the bytes that they are written as. */
Status instance_save(Instance *, void **state);
Status instance_restore(Instance *, const void *state);
Status instance_forget(void **state);
Status instance_state_size(const Instance *, size_t *size);
Status instance_write(const Instance *, const void *state, char bytes[], size_t size);
Status instance_read(const Instance *, const char bytes[], size_t size, void **state);

Status instance_derivatives(Instance *, const Reference unknown[], size_t unknowns, const Reference known[],
                            size_t knowns, const double seed[], double x[]);

/* Co-Simulation. */
__attribute__((noinline)) Status instance_step_any(Instance *, double time, double step);

static inline Status instance_step(Instance *self, double time, double step)
{
    return tire_glides(&self->tire, time, step) ? OK : instance_step_any(self, time, step);
}

/* Model Exchange. */
Status instance_set_time(Instance *, double time);
Status instance_set_states(Instance *, const double x[], size_t n);
Status instance_get_states(Instance *, double x[], size_t n);
Status instance_get_rates(Instance *, double x[], size_t n);
Status instance_get_nominals(Instance *, double x[], size_t n);
Status instance_get_indicators(Instance *, double x[], size_t n); /* the tire's own deflection [m] */
Status instance_accept(Instance *);
Status instance_enter_event(Instance *);

#endif
