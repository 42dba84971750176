/* The step of a bicycle tire. Made from the Python of radialtire; change that, not this. */
#ifndef KERNEL_H
#define KERNEL_H

#define LAYOUT "e8466e2547a0d4ee" /* what stands where in p and s */
enum {
    PARAMETERS = 126,
    STATES = 183,
    S_TIME = 0,
    S_STARTED = 4,
    P_TRACKED = 0, /* p: rate and acceleration follow from the readings */
    P_TWO_SIDED = 4, P_INFLATED = 6,
    P_CONTINUOUS = 3, /* p: effects that are differential equations are a solver's */
    CHANNELS = 2, /* quantities after the first five of a motion */
    LAW_TABLES = 19 /* q: number of tables after the law's parameters */
};

/* s before the first sample. */
extern const double REST[STATES];

typedef struct { double v[2]; } Vector2;
typedef struct { double v[7]; } Vector7;
typedef Vector7 Motion;

double tire_elastic(double deflection, double coefficient, double exponent);
double tire_elastic_tangent(double deflection, double coefficient, double exponent);
Vector2 tire_step(Vector2 law, Vector7 motion, const double *p, const double *s, double *n);
double tire_stiffness(Vector2 law, Vector7 motion, const double *p, const double *s, double *n);
Vector2 tire_law(const double *q, double surface_radius);

#endif
