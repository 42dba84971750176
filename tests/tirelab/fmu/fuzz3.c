/*
 * Calls every function of the native FMU, FMI 3.0, in random order with random values, good and bad, for some seconds.
 *
 *     cc -fsanitize=address,undefined fuzz3.c kernel.c tire.c instance.c fmi3.c -lm -o fuzz && ./fuzz RESOURCES TOKEN SECONDS SEED
 *
 * Prints how many calls were made and how many gave each status; a fault ends it through the sanitizers.
 */
#include "fuzz.h"

#include <stdbool.h>
#include <stdint.h>

typedef unsigned Ref;
typedef void (*Logger)(void *, int, const char *, const char *);

const char *fmi3GetVersion(void);
void *fmi3InstantiateModelExchange(const char *, const char *, const char *, bool, bool, void *, Logger);
void *fmi3InstantiateCoSimulation(const char *, const char *, const char *, bool, bool, bool, bool, const Ref *, size_t, void *,
                                  Logger, void (*)(void));
void *fmi3InstantiateScheduledExecution(const char *, const char *, const char *, bool, bool, void *, Logger, void (*)(void),
                                        void (*)(void), void (*)(void));
void fmi3FreeInstance(void *);
int fmi3SetDebugLogging(void *, bool, size_t, const char *const *);
int fmi3EnterInitializationMode(void *, bool, double, double, bool, double), fmi3ExitInitializationMode(void *);
int fmi3Terminate(void *), fmi3Reset(void *), fmi3EnterEventMode(void *), fmi3EnterContinuousTimeMode(void *);
int fmi3GetFloat64(void *, const Ref *, size_t, double *, size_t), fmi3SetFloat64(void *, const Ref *, size_t, const double *, size_t);
int fmi3GetBoolean(void *, const Ref *, size_t, bool *, size_t), fmi3SetBoolean(void *, const Ref *, size_t, const bool *, size_t);
int fmi3GetFMUState(void *, void **), fmi3SetFMUState(void *, void *), fmi3FreeFMUState(void *, void **);
int fmi3SerializedFMUStateSize(void *, void *, size_t *), fmi3SerializeFMUState(void *, void *, uint8_t *, size_t);
int fmi3DeserializeFMUState(void *, const uint8_t *, size_t, void **);
int fmi3GetDirectionalDerivative(void *, const Ref *, size_t, const Ref *, size_t, const double *, size_t, double *, size_t);
int fmi3DoStep(void *, double, double, bool, bool *, bool *, bool *, double *);
int fmi3UpdateDiscreteStates(void *, bool *, bool *, bool *, bool *, bool *, double *);
int fmi3CompletedIntegratorStep(void *, bool, bool *, bool *), fmi3SetTime(void *, double);
int fmi3SetContinuousStates(void *, const double *, size_t), fmi3GetContinuousStates(void *, double *, size_t);
int fmi3GetContinuousStateDerivatives(void *, double *, size_t), fmi3GetEventIndicators(void *, double *, size_t);
int fmi3GetNominalsOfContinuousStates(void *, double *, size_t);
int fmi3GetNumberOfContinuousStates(void *, size_t *), fmi3GetNumberOfEventIndicators(void *, size_t *);

/* Types that no variable has: the arguments that all of them begin with, then values that must not be touched. */
#define TYPES(X) X(Float32) X(Int8) X(UInt8) X(Int16) X(UInt16) X(Int32) X(UInt32) X(Int64) X(UInt64) X(String) X(Binary) X(Clock)
#define PROTOTYPES(Name) \
    int fmi3Get##Name(void *, const Ref *, size_t, void *, size_t), fmi3Set##Name(void *, const Ref *, size_t, const void *, size_t);
TYPES(PROTOTYPES)
#define BOTH(Name) fmi3Get##Name, (Typed)fmi3Set##Name,
typedef int (*Typed)(void *, const Ref *, size_t, void *, size_t);
static const Typed typed[] = {TYPES(BOTH)};

/* What this FMU does not have: refused whatever its arguments, NULL here. */
#define MISSING(X) \
    X(GetNumberOfVariableDependencies) X(GetVariableDependencies) X(GetAdjointDerivative) X(EnterConfigurationMode) \
    X(ExitConfigurationMode) X(GetIntervalDecimal) X(GetIntervalFraction) X(GetShiftDecimal) X(GetShiftFraction) \
    X(SetIntervalDecimal) X(SetIntervalFraction) X(SetShiftDecimal) X(SetShiftFraction) X(EvaluateDiscreteStates) \
    X(EnterStepMode) X(GetOutputDerivatives) X(ActivateModelPartition)
typedef int (*Missing)(void *, void *, void *, void *, void *, void *, void *, void *);
#define PROTOTYPE(Name) int fmi3##Name(void *, void *, void *, void *, void *, void *, void *, void *);
MISSING(PROTOTYPE)
#define ALONE(Name) fmi3##Name,
static const Missing missing[] = {MISSING(ALONE)};

static void told(void *environment, int status, const char *category, const char *text)
{
    (void)environment, (void)status, (void)category;
    messages += *text != 0;
}

static void *made(const char *name, const char *token, const char *resources)
{
    switch (draw(5)) {
    case 0: case 1:
        return fmi3InstantiateModelExchange(name, token, resources, false, true, NULL, told);
    case 2: case 3:
        return fmi3InstantiateCoSimulation(name, token, resources, false, false, false, draw(2), NULL, 0, NULL, told, NULL);
    default:
        return draw(2) ? fmi3InstantiateCoSimulation(name, token, resources, false, false, true, false, NULL, 0, NULL, told, NULL)
                       : fmi3InstantiateScheduledExecution(name, token, resources, false, false, NULL, told, NULL, NULL, NULL);
    }
}

/* A state written and read, half of the times changed on the way. */
static int written(void *tire, void *state)
{
    size_t size = 0;
    void *copy = NULL;
    int status = fmi3SerializedFMUStateSize(tire, state, draw(9) ? &size : NULL);
    if (!state || !size)
        return status;
    uint8_t *bytes = malloc(size);
    status = fmi3SerializeFMUState(tire, state, bytes, size);
    if (draw(2))
        change(bytes, size);
    counted(status);
    status = fmi3DeserializeFMUState(tire, bytes, draw(9) ? size : draw((unsigned)size), &copy);
    if (copy && draw(2))
        counted(fmi3SetFMUState(tire, copy));
    fmi3FreeFMUState(tire, &copy);
    free(bytes);
    return status;
}

static int call(void *tire, void **state, double *time_now)
{
    static double reached; /* of the last step, which is what a host knows */
    Ref v[4];
    double x[32], y[32];
    bool n[32] = {false};
    size_t number = 0;
    const size_t count = draw(5), values = draw(9) ? count : draw(5), some = draw(9);
    for (int k = 0; k < 4; k++)
        v[k] = reference();
    for (int k = 0; k < 32; k++) {
        x[k] = real();
        n[k] = draw(2);
    }
    switch (draw(36)) {
    case 0: reached = 0; return fmi3EnterInitializationMode(tire, draw(2), real(), draw(4) ? 0 : real(), draw(2), real());
    case 1: return fmi3ExitInitializationMode(tire);
    case 2: return draw(20) ? 0 : fmi3Terminate(tire);
    case 3: return draw(20) ? 0 : fmi3Reset(tire);
    case 4: case 5: return fmi3GetFloat64(tire, v, count, y, values);
    case 6: case 7: case 8: return fmi3SetFloat64(tire, v, count, x, values);
    case 9: return fmi3GetBoolean(tire, v, count, n, values);
    case 10: return fmi3SetBoolean(tire, v, count, n, values);
    case 11: return typed[draw(sizeof typed / sizeof *typed)](tire, draw(2) ? v : NULL, count, NULL, values);
    case 12: return missing[draw(sizeof missing / sizeof *missing)](tire, NULL, NULL, NULL, NULL, NULL, NULL, NULL);
    case 13: return fmi3GetFMUState(tire, draw(20) ? state : NULL);
    case 14: return fmi3SetFMUState(tire, *state);
    case 15: return fmi3FreeFMUState(tire, state);
    case 16: return written(tire, *state);
    case 17: return fmi3GetDirectionalDerivative(tire, v, count % 3, v + 2, some % 3, x, some % 3, y, values % 3);
    case 18: return fmi3EnterEventMode(tire);
    case 19: return fmi3UpdateDiscreteStates(tire, n, n + 1, n + 2, n + 3, n + 4, draw(9) ? y : NULL);
    case 20: return fmi3EnterContinuousTimeMode(tire);
    case 21: return fmi3CompletedIntegratorStep(tire, draw(2), n, draw(9) ? n + 1 : NULL);
    case 22: return fmi3SetTime(tire, draw(3) ? *time_now += 1e-3 : real());
    case 23: return fmi3SetContinuousStates(tire, x, some);
    case 24: return fmi3GetContinuousStates(tire, y, some);
    case 25: return fmi3GetContinuousStateDerivatives(tire, y, some);
    case 26: return fmi3GetEventIndicators(tire, y, draw(2));
    case 27: return fmi3GetNominalsOfContinuousStates(tire, y, some);
    case 28: return fmi3GetNumberOfContinuousStates(tire, draw(9) ? &number : NULL);
    case 29: return fmi3GetNumberOfEventIndicators(tire, draw(9) ? &number : NULL);
    case 30: return draw(2) ? fmi3GetFloat64(tire, NULL, count, y, count) : fmi3SetFloat64(tire, v, count, NULL, count);
    case 31: return fmi3SetDebugLogging(tire, draw(2), 0, NULL);
    default: {
        double *end = draw(20) ? &reached : NULL;
        const double begin = draw(9) ? reached : real();
        return fmi3DoStep(tire, begin, draw(5) ? 1e-3 * (double)draw(30) : real(), draw(2), n, n + 1, n + 2, end);
    }
    }
}

int main(int argc, char **argv)
{
    static const char *const tokens[] = {NULL, "", "{00000000-0000-0000-0000-000000000000}"};
    static const char *const places[] = {NULL, "", "/nowhere", "/nowhere/", "file:///nowhere"};
    if (argc != 5 || strcmp(fmi3GetVersion(), "3.0"))
        return 2;
    const time_t end = time(NULL) + atol(argv[3]);
    seed = strtoull(argv[4], NULL, 10);
    for (int kind = 0; time(NULL) < end; kind = !kind) {
        const char *token = argv[2], *resources = argv[1];
        void *state = NULL;
        double time_now = 0;
        void *tire = kind ? fmi3InstantiateModelExchange("tire", token, resources, false, false, NULL, told)
                          : fmi3InstantiateCoSimulation("tire", token, resources, false, false, false, false, NULL, 0, NULL, told, NULL);
        if (!tire)
            return 1;
        fmi3FreeInstance(made(draw(2) ? "" : NULL, tokens[draw(3)], resources));
        fmi3FreeInstance(made("tire", token, places[draw(5)]));
        fmi3FreeInstance(made("tire", token, resources));
        for (int i = 0; i < 3000; i++)
            counted(call(draw(1000) ? tire : NULL, &state, &time_now));
        fmi3FreeFMUState(tire, &state);
        fmi3FreeInstance(tire);
    }
    printf("%ld calls, %ld taken, %ld refused, %ld messages\n", calls, taken, refused, messages);
    return 0;
}
