/*
 * The tire of Hull, Wang and Moore (1996) as an FMU in plain C, against which the speed of the real one is measured.
 *
 * F = A x^B (eq. 2) with the deflection x in cm; A and B of the surface radius in cm by eqs. 5a to 6b (convex > 0,
 * concave < 0), flat as their common limit. Value references: 0 deflection [m], 1 surface radius [m], 2 force [N].
 */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

typedef struct {
    double value[3];
} Tire;

static double force(double deflection, double radius)
{
    double a = 550.9, b = 1.422;
    if (!(deflection > 0))
        return 0;
    radius *= 100;
    if (radius > 0 && radius < 1e7) {
        a -= 337.8 * exp(-0.2519 * radius); /* 5a */
        b -= 0.2469 * exp(-0.1651 * radius); /* 6a */
    } else if (radius < 0 && radius > -1e7) {
        a += 7822.0 * exp(0.1398 * radius); /* 5b */
        b += 0.2128 * exp(0.0289 * radius); /* 6b */
    }
    return a * pow(100 * deflection, b);
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *functions,
                      int visible, int logging)
{
    (void)name, (void)type, (void)guid, (void)resources, (void)functions, (void)visible, (void)logging;
    return calloc(1, sizeof(Tire));
}

void fmi2FreeInstance(void *tire) { free(tire); }

int fmi2SetupExperiment(void *tire, int has_tolerance, double tolerance, double start, int has_stop, double stop)
{
    (void)tire, (void)has_tolerance, (void)tolerance, (void)start, (void)has_stop, (void)stop;
    return 0;
}

int fmi2EnterInitializationMode(void *tire) { return !tire; }
int fmi2ExitInitializationMode(void *tire) { return !tire; }
int fmi2Terminate(void *tire) { return !tire; }

int fmi2SetReal(void *tire, const unsigned *references, size_t count, const double *values)
{
    for (size_t i = 0; i < count; i++)
        ((Tire *)tire)->value[references[i]] = values[i];
    return 0;
}

int fmi2GetReal(void *tire, const unsigned *references, size_t count, double *values)
{
    for (size_t i = 0; i < count; i++)
        values[i] = ((Tire *)tire)->value[references[i]];
    return 0;
}

int fmi2DoStep(void *tire, double time, double step, int no_rewind)
{
    double *value = ((Tire *)tire)->value;
    (void)time, (void)step, (void)no_rewind;
    value[2] = force(value[0], value[1]);
    return 0;
}

/* What nobody calls here, but fmpy looks for: fmi2Error. */
#define UNSUPPORTED(name) \
    int fmi2##name(void) { return 3; }
UNSUPPORTED(SetDebugLogging)
UNSUPPORTED(Reset)
UNSUPPORTED(GetInteger)
UNSUPPORTED(GetBoolean)
UNSUPPORTED(GetString)
UNSUPPORTED(SetInteger)
UNSUPPORTED(SetBoolean)
UNSUPPORTED(SetString)
UNSUPPORTED(GetFMUstate)
UNSUPPORTED(SetFMUstate)
UNSUPPORTED(FreeFMUstate)
UNSUPPORTED(SerializedFMUstateSize)
UNSUPPORTED(SerializeFMUstate)
UNSUPPORTED(DeSerializeFMUstate)
UNSUPPORTED(GetDirectionalDerivative)
UNSUPPORTED(SetRealInputDerivatives)
UNSUPPORTED(GetRealOutputDerivatives)
UNSUPPORTED(CancelStep)
UNSUPPORTED(GetStatus)
UNSUPPORTED(GetRealStatus)
UNSUPPORTED(GetIntegerStatus)
UNSUPPORTED(GetBooleanStatus)
UNSUPPORTED(GetStringStatus)
