/*
 * Instantiates the native FMU, FMI 2.0, on every folder of tire data that is given, whole or broken, and steps it.
 *
 *     cc -fsanitize=address,undefined broken_tires.c kernel.c tire.c instance.c fmi2.c -lm && ./a.out GUID RESOURCES...
 *
 * Prints how many were taken, how many refused, and how many messages there were; a fault ends it through the sanitizers.
 */
#include <stdio.h>
#include <stdlib.h>

#include "callbacks.h"

int fmi2SetupExperiment(void *, int, double, double, int, double);
int fmi2EnterInitializationMode(void *), fmi2ExitInitializationMode(void *);
int fmi2GetReal(void *, const unsigned *, size_t, double *), fmi2SetReal(void *, const unsigned *, size_t, const double *);
int fmi2DoStep(void *, double, double, int), fmi2GetFMUstate(void *, void **), fmi2FreeFMUstate(void *, void **);

static long messages;
static void told(void *environment, const char *name, int status, const char *category, const char *format, ...)
{
    (void)environment, (void)name, (void)status, (void)category;
    messages += *format != 0;
}

int main(int argc, char **argv)
{
    const Callbacks callbacks = {told, calloc, free, NULL, NULL};
    const unsigned inputs[] = {0, 1}, output = 2;
    long taken = 0, refused = 0;
    for (int i = 2; i < argc; i++) {
        void *state = NULL, *tire = fmi2Instantiate("tire", 1, argv[1], argv[i], &callbacks, 0, 0);
        double force, x[] = {0.01, 1e5};
        if (!tire) {
            refused++;
            continue;
        }
        taken++;
        fmi2SetupExperiment(tire, 0, 0, 0, 0, 0);
        fmi2EnterInitializationMode(tire);
        fmi2SetReal(tire, inputs, 2, x);
        fmi2ExitInitializationMode(tire);
        for (int k = 0; k < 50; k++) {
            x[0] = 0.0004 * (k % 40) - 0.002;
            fmi2SetReal(tire, inputs, 2, x);
            fmi2DoStep(tire, 0.01 * k, 0.01, 1);
            fmi2GetReal(tire, &output, 1, &force);
        }
        fmi2GetFMUstate(tire, &state);
        fmi2FreeFMUstate(tire, &state);
        fmi2FreeInstance(tire);
    }
    printf("%ld taken, %ld refused, %ld messages\n", taken, refused, messages);
    return 0;
}
