/*
 * Calls every function of the native FMU, FMI 2.0, in random order with random values, good and bad, for some seconds.
 *
 *     cc -fsanitize=address,undefined fuzz.c kernel.c tire.c instance.c fmi2.c -lm -o fuzz && ./fuzz RESOURCES GUID SECONDS SEED
 *
 * With -DCO_SIMULATION_ONLY and linked to the loader's library in place of these sources: the Python FMU.
 * Prints how many calls were made and how many gave each status; a fault ends it through the sanitizers.
 */
#include "callbacks.h"
#include "fuzz.h"

int fmi2SetDebugLogging(void *, int, size_t, const char *const *), fmi2SetupExperiment(void *, int, double, double, int, double);
int fmi2EnterInitializationMode(void *), fmi2ExitInitializationMode(void *), fmi2Terminate(void *), fmi2Reset(void *);
int fmi2GetReal(void *, const unsigned *, size_t, double *), fmi2SetReal(void *, const unsigned *, size_t, const double *);
int fmi2GetBoolean(void *, const unsigned *, size_t, int *), fmi2SetBoolean(void *, const unsigned *, size_t, const int *);
int fmi2GetInteger(void *, const unsigned *, size_t, int *), fmi2SetInteger(void *, const unsigned *, size_t, const int *);
int fmi2GetFMUstate(void *, void **), fmi2SetFMUstate(void *, void *), fmi2FreeFMUstate(void *, void **);
int fmi2SerializedFMUstateSize(void *, void *, size_t *), fmi2SerializeFMUstate(void *, void *, char *, size_t);
int fmi2DeSerializeFMUstate(void *, const char *, size_t, void **);
int fmi2GetDirectionalDerivative(void *, const unsigned *, size_t, const unsigned *, size_t, const double *, double *);
int fmi2DoStep(void *, double, double, int), fmi2GetRealStatus(void *, int, double *), fmi2CancelStep(void *);
#ifdef CO_SIMULATION_ONLY
#define KINDS 1 + 0 *
#define OF_MODEL_EXCHANGE(call) 0
#else
#define KINDS
#define OF_MODEL_EXCHANGE(call) call
int fmi2EnterEventMode(void *), fmi2NewDiscreteStates(void *, void *), fmi2EnterContinuousTimeMode(void *);
int fmi2CompletedIntegratorStep(void *, int, int *, int *), fmi2SetTime(void *, double);
int fmi2SetContinuousStates(void *, const double *, size_t), fmi2GetContinuousStates(void *, double *, size_t);
int fmi2GetDerivatives(void *, double *, size_t), fmi2GetEventIndicators(void *, double *, size_t);
int fmi2GetNominalsOfContinuousStates(void *, double *, size_t);
#endif

static void told(void *environment, const char *name, int status, const char *category, const char *format, ...)
{
    char line[2000];
    va_list arguments;
    (void)environment, (void)name, (void)status, (void)category;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    messages += *line != 0;
}

int main(int argc, char **argv)
{
    const Callbacks callbacks = {told, calloc, free, NULL, NULL};
    if (argc != 5)
        return 2;
    const time_t end = time(NULL) + atol(argv[3]);
    seed = strtoull(argv[4], NULL, 10);
    while (time(NULL) < end) {
        static const char *const guids[] = {NULL, "", "{00000000-0000-0000-0000-000000000000}"};
        static const char *const places[] = {NULL, "", "file:///nowhere", "file://%zz%", "file:"};
        void *tire = fmi2Instantiate("tire", KINDS (int)draw(2), argv[2], argv[1], &callbacks, 0, 0);
        void *state = NULL;
        double time_now = 0;
        if (!tire)
            return 1;
        fmi2FreeInstance(fmi2Instantiate(draw(2) ? "" : NULL, (int)draw(3), guids[draw(3)], argv[1], &callbacks, 0, 1));
        fmi2FreeInstance(fmi2Instantiate("tire", 1, argv[2], places[draw(5)], &callbacks, 0, 1));
        for (int i = 0; i < 3000; i++) {
            unsigned v[4];
            double x[32], y[32];
            int n[32] = {0}, flags[2];
            const size_t count = draw(5), some = draw(9);
            size_t size = 0;
            int status = 0;
            for (int k = 0; k < 4; k++)
                v[k] = reference();
            for (int k = 0; k < 32; k++)
                x[k] = real();
            switch (draw(34)) {
            case 0: status = fmi2SetupExperiment(tire, 0, 0, draw(4) ? 0 : real(), 0, 0); break;
            case 1: status = fmi2EnterInitializationMode(tire); break;
            case 2: status = fmi2ExitInitializationMode(tire); break;
            case 3: status = draw(20) ? 0 : fmi2Terminate(tire); break;
            case 4: status = draw(20) ? 0 : fmi2Reset(tire); break;
            case 5: case 6: status = fmi2GetReal(tire, v, count, y); break;
            case 7: case 8: case 9: status = fmi2SetReal(tire, v, count, x); break;
            case 10: status = fmi2GetBoolean(tire, v, count, n); break;
            case 11: status = fmi2SetBoolean(tire, v, count, n); break;
            case 12: status = fmi2GetInteger(tire, v, count, n); break;
            case 13: status = fmi2SetInteger(tire, NULL, count, NULL); break;
            case 14: status = fmi2GetFMUstate(tire, &state); break;
            case 15: status = state ? fmi2SetFMUstate(tire, state) : 0; break;
            case 16: status = fmi2FreeFMUstate(tire, &state); break;
            case 17:
                fmi2SerializedFMUstateSize(tire, state, &size);
                if (state && size) {
                    char *bytes = malloc(size);
                    void *copy = NULL;
                    status = fmi2SerializeFMUstate(tire, state, bytes, size);
                    if (draw(2))
                        change((unsigned char *)bytes, size);
                    status |= fmi2DeSerializeFMUstate(tire, bytes, draw(9) ? size : draw((unsigned)size), &copy);
                    if (copy && draw(2))
                        counted(fmi2SetFMUstate(tire, copy));
                    fmi2FreeFMUstate(tire, &copy);
                    free(bytes);
                }
                break;
            case 18: status = fmi2GetDirectionalDerivative(tire, v, draw(3), v + 2, draw(3), x, y); break;
            case 19: status = fmi2GetRealStatus(tire, (int)draw(4), y); break;
            case 20: status = fmi2CancelStep(tire); break;
            case 21: status = OF_MODEL_EXCHANGE(fmi2EnterEventMode(tire)); break;
            case 22: status = OF_MODEL_EXCHANGE(fmi2NewDiscreteStates(tire, draw(9) ? y : NULL)); break;
            case 23: status = OF_MODEL_EXCHANGE(fmi2EnterContinuousTimeMode(tire)); break;
            case 24: status = OF_MODEL_EXCHANGE(fmi2CompletedIntegratorStep(tire, 1, flags, draw(9) ? flags + 1 : NULL)); break;
            case 25: status = OF_MODEL_EXCHANGE(fmi2SetTime(tire, draw(3) ? time_now += 1e-3 : real())); break;
            case 26: status = OF_MODEL_EXCHANGE(fmi2SetContinuousStates(tire, x, some)); break;
            case 27: status = OF_MODEL_EXCHANGE(fmi2GetContinuousStates(tire, y, some)); break;
            case 28: status = OF_MODEL_EXCHANGE(fmi2GetDerivatives(tire, y, some)); break;
            case 29: status = OF_MODEL_EXCHANGE(fmi2GetEventIndicators(tire, y, draw(2))); break;
            case 30: status = OF_MODEL_EXCHANGE(fmi2GetNominalsOfContinuousStates(tire, y, some)); break;
            case 31: status = fmi2GetReal(tire, NULL, count, y); break;
            default: {
                double reached = 0;
                fmi2GetRealStatus(tire, 2, &reached);
                status = fmi2DoStep(tire, draw(9) ? reached : real(), draw(5) ? 1e-3 * (double)draw(30) : real(), 1);
            }
            }
            counted(status);
        }
        fmi2FreeFMUstate(tire, &state);
        fmi2FreeInstance(tire);
    }
    printf("%ld calls, %ld taken, %ld refused, %ld messages\n", calls, taken, refused, messages);
    return 0;
}
