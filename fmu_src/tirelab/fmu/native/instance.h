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

/* A message where a call is not allowed; false. */
bool not_allowed(const Instance *, String function);

static inline bool allowed(const Instance *self, int states, String function)
{
    return self && (self->tire.m.stage & states || not_allowed(self, function));
}

/* Tell the host of a status; the status. */
Status tell(const Instance *, Status, String text);
__attribute__((format(printf, 2, 3))) Status fail(const Instance *, String format, ...);

/* A new instance like `how`, with a tire read from its data; NULL and a message where that cannot be done. */
Instance *instance_new(Instance how, String name, String guid, String resources);
void instance_free(Instance *);

Status instance_start_at(Instance *, double start, bool has_stop, double stop);
Status instance_begin(Instance *);

Status instance_get_reals(Instance *, const Reference v[], size_t n, double x[]);
Status instance_set_reals(Instance *, const Reference v[], size_t n, const double x[]);
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
Status instance_step(Instance *, double time, double step);

/* Model Exchange. */
Status instance_set_time(Instance *, double time);
Status instance_set_states(Instance *, const double x[], size_t n);
Status instance_get_states(Instance *, double x[], size_t n);
Status instance_get_rates(Instance *, double x[], size_t n);
Status instance_get_nominals(Instance *, double x[], size_t n);
Status instance_get_indicators(Instance *, double x[], size_t n);
Status instance_accept(Instance *);

#endif
