/* The step of a bicycle tire. Made from the Python of radialtire; change that, not this. */
#ifndef KERNEL_H
#define KERNEL_H

#define LAYOUT "92c65f2033152fd9" /* what stands where in p and s */
enum {
    PARAMETERS = 86,
    STATES = 180,
    S_TIME = 0,
    S_STARTED = 4,
    P_TRACKED = 0, /* p: rate and acceleration follow from the readings */
    P_CONTINUOUS = 3, /* p: effects that are differential equations are a solver's */
    LAW_TABLES = 19 /* q: number of tables after the law's parameters */
};

/* s before the first sample. */
extern const double REST[STATES];

typedef struct { double v[2]; } Vector2;
typedef struct { double v[5]; } Vector5;

double tire_elastic(double deflection, double coefficient, double exponent);
double tire_elastic_tangent(double deflection, double coefficient, double exponent);
Vector2 tire_step(Vector2 law, Vector5 motion, const double *p, const double *s, double *n);
double tire_stiffness(Vector2 law, Vector5 motion, const double *p, const double *s, double *n);
Vector2 tire_law(const double *q, double surface_radius);

#endif
