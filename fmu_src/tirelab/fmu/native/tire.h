/* One tire in an FMU: its data, its inputs, its state, and what it answers. Nothing here is shared between tires. */
#ifndef TIRE_H
#define TIRE_H

#include "kernel.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "fmi2_states.h"

/* The rows of numbers that a parameter can stand in. */
enum { OF_LAW, OF_EFFECTS };

typedef struct {
    char name[72];
    int row, index;
    double minimum, maximum;
} Parameter;

/* The value references: the variables of every tire, then its parameters, then its channels, then those of a tire that
   knows its motion. */
enum { DEFLECTION, SURFACE_RADIUS, RADIAL_FORCE, RADIAL_STIFFNESS, IN_TESTED_RANGE, FIRST_PARAMETER };
/* after the channels: */
enum { DEFLECTION_RATE, DEFLECTION_ACCELERATION, MOTION_GIVEN, MOTION_VARIABLES };
enum { MOST_CONTINUOUS = 8 };

#define DEFLECTION_MIN (-1e3) /* deflections accepted [m], as radialtire.model */
#define DEFLECTION_MAX 0.33   /* of a tire; a part has -DEFLECTION_MIN */

typedef struct {
    double deflection, radius, rate, acceleration;
    double channels[CHANNELS]; /* of the tire, in the order of their references */
} Inputs;

/* An input beside the motion, such as the pressure: its number among all, and the value that stands for none. */
typedef struct {
    char name[32];
    int number;
    double start, minimum, maximum, unknown;
} Channel;

/* What an FMU state holds beside the rows of law and effects. */
typedef struct {
    Inputs inputs;
    double time;      /* of the values that are asked for */
    double reached;   /* the end of the last step */
    double stop;      /* the end of the experiment, infinite where none was said */
    int given;        /* whether rate and acceleration are inputs */
    int stage;        /* the state of the standard */
    double s[STATES];
    double earlier[STATES]; /* in Model Exchange: before the step that a solver completed last */
} Memory;

typedef struct {
    char guid[64];
    Parameter *parameters;
    int count;
    Channel channels[CHANNELS];
    int channel_count;
    double *q, *p;       /* numbers of the law and of the effects */
    double *start;       /* the same as they were read, one after the other */
    size_t law;          /* how many of the law */
    bool bare;           /* no effect */
    bool moves;          /* an effect uses rate or acceleration */
    double deflection_max; /* accepted [m] */
    double range[4];     /* curvature from and to [1/m], deflection [m], force [N] */
    bool tested;
    int continuous[MOST_CONTINUOUS], continuous_count; /* indices in s that are a solver's */
    int whole[MOST_CONTINUOUS]; /* indices of the sums of these and of what steps keep in their places; else the same */

    bool exchange;       /* Model Exchange */
    bool newer;          /* FMI 3.0: time and the deflection that tells of contact are variables, after the others */
    Memory m;
    double n[STATES];    /* the state after the inputs were tried */
    bool current;        /* force is that of the inputs */
    bool unchecked;      /* a parameter was set since the last check */
    Vector2 coefficients; /* A and B on the surface of radius `surface` */
    double surface; /* not a number where they are to be computed anew */
    double force, compression;
} Tire;

enum { TROUBLE = 600 };

/* Read the data of the tire from the FMU's resources; a sentence in `trouble` where that cannot be done. */
bool tire_read(Tire *tire, const char *resources, const char *guid, char trouble[TROUBLE]);
void tire_free(Tire *tire);

/* As it was after it was read. */
void tire_reset(Tire *tire);

/* Evaluate the inputs at the time, without changing the state; a sentence where no tire can have them. */
bool tire_try(Tire *tire, double time, char trouble[TROUBLE]);

/* The same, and take the state after it. */
bool tire_accept(Tire *tire, double time, char trouble[TROUBLE]);

/* Let nothing come before what is kept: another value of the inputs at the same time is a change from it. */
void tire_settle(Tire *tire);

/* Begin the history with the inputs of the start. */
bool tire_begin(Tire *tire, double start, char trouble[TROUBLE]);

/* The states of a solver and their rates, in co-simulation too: of the inputs that were tried last. */
void tire_flow(Tire *tire, double states[], double rates[]);

double tire_tangent(Tire *tire);
bool tire_in_range(const Tire *tire);

/* Real variables by reference; false where there is none that can be read or set. */
bool tire_get(Tire *tire, unsigned reference, double *value);
bool tire_set(Tire *tire, unsigned reference, double value);
bool tire_can_set(Tire *tire, unsigned reference);

/* The change of a value per unit of a change of inputs, parameters and states along a direction, by differences. */
bool tire_derivative(Tire *tire, unsigned unknown, const unsigned known[], const double seed[], size_t count,
                     double *value);

/* The usual step of a tire without effects, on the surface of the last one: the force alone is new. False where it is
   another one, and then nothing is changed. */
static inline bool tire_glides(Tire *tire, double time, double step)
{
    const Inputs *const u = &tire->m.inputs;
    const double end = time + step;
    if (!tire->bare || u->radius != tire->surface || time != tire->m.reached || !(step >= 0 && end <= tire->m.stop)
        || !(DEFLECTION_MIN <= u->deflection && u->deflection <= tire->deflection_max))
        return false;
    const double force = tire_elastic(u->deflection, tire->coefficients.v[0], tire->coefficients.v[1]);
    if (!isfinite(force) || !isfinite(end))
        return false;
    tire->force = force;
    tire->compression = u->deflection;
    tire->current = true;
    tire->m.time = tire->m.reached = end;
    return true;
}

/* Make a step; a sentence where it may not begin, is too long, or ends with inputs that no tire has. */
bool tire_advance(Tire *tire, double time, double step, char trouble[TROUBLE]);

/* Whether a reference is that of the Boolean parameter motion_given. */
bool tire_is_motion_given(const Tire *tire, unsigned reference);
void tire_give_motion(Tire *tire, bool given);

/* The number of the variable among those of the motion, or among states and their derivatives, or -1. */
int tire_motion_variable(const Tire *tire, unsigned reference);
int tire_state_variable(const Tire *tire, unsigned reference);

/* The number of value references, all of which are in use. */
unsigned tire_references(const Tire *tire);

/* States as bytes. */
size_t tire_state_size(const Tire *tire);
void tire_save(const Tire *tire, char *bytes);
bool tire_is_state(const Tire *tire, const char *bytes, size_t size, char trouble[TROUBLE]);
bool tire_restore(Tire *tire, const char *bytes, size_t size, char trouble[TROUBLE]);

#endif
