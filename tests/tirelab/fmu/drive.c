/*
 * A plain host without Python, for any platform: drives an FMI 2.0 Co-Simulation binary along a file.
 *
 *     drive LIBRARY GUID RESOURCES IN OUT
 *
 * IN holds rows of three doubles: deflection, surface radius, time; OUT gets a force for each. Halfway the state is saved
 * as bytes, ten steps are made elsewhere, and the state is restored.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef _WIN32
#include <windows.h>
#define OPEN(path) (void *)LoadLibraryA(path)
#define FIND(library, name) (void *)GetProcAddress((HMODULE)library, name)
#else
#include <dlfcn.h>
#define OPEN(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) dlsym(library, name)
#endif

typedef struct {
    void *logger, *allocate, *release, *finished, *environment;
} Callbacks;

static void told(void *environment, const char *name, int status, const char *category, const char *format, ...)
{
    va_list arguments;
    (void)environment, (void)category;
    va_start(arguments, format);
    fprintf(stderr, "[%s %d] ", name, status);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

static int failed(const char *what)
{
    fprintf(stderr, "drive: %s\n", what);
    return 1;
}

#define GET(result, name, ...) \
    result (*name)(__VA_ARGS__) = (result(*)(__VA_ARGS__))FIND(library, #name); \
    if (!name) \
        return failed("no " #name);
#define CHECK(call) \
    if (call) \
        return failed(#call);

int main(int argc, char **argv)
{
    static double u[3 * 100000], y[100000], away[2] = {0.02, 0.5};
    static const unsigned inputs[2] = {0, 1}, output[1] = {2};
    const Callbacks callbacks = {(void *)told, (void *)calloc, (void *)free, 0, 0};
    void *state = NULL, *again = NULL, *library = argc == 6 ? OPEN(argv[1]) : NULL;
    size_t size = 0;
    if (!library)
        return failed("the library does not open");
    GET(void *, fmi2Instantiate, const char *, int, const char *, const char *, const Callbacks *, int, int)
    GET(int, fmi2SetupExperiment, void *, int, double, double, int, double)
    GET(int, fmi2EnterInitializationMode, void *)
    GET(int, fmi2ExitInitializationMode, void *)
    GET(int, fmi2SetReal, void *, const unsigned *, size_t, const double *)
    GET(int, fmi2GetReal, void *, const unsigned *, size_t, double *)
    GET(int, fmi2DoStep, void *, double, double, int)
    GET(int, fmi2GetFMUstate, void *, void **)
    GET(int, fmi2SerializedFMUstateSize, void *, void *, size_t *)
    GET(int, fmi2SerializeFMUstate, void *, void *, char *, size_t)
    GET(int, fmi2DeSerializeFMUstate, void *, const char *, size_t, void **)
    GET(int, fmi2SetFMUstate, void *, void *)
    GET(int, fmi2FreeFMUstate, void *, void **)
    GET(int, fmi2Terminate, void *)
    GET(void, fmi2FreeInstance, void *)
    FILE *file = fopen(argv[4], "rb");
    if (!file)
        return failed("no such file");
    const size_t count = fread(u, 3 * sizeof *u, 100000, file);
    fclose(file);
    void *tire = fmi2Instantiate("tire", 1, argv[2], argv[3], &callbacks, 0, 0);
    if (!tire)
        return failed("no instance");
    CHECK(fmi2SetupExperiment(tire, 0, 0, u[2], 0, 0))
    CHECK(fmi2EnterInitializationMode(tire))
    CHECK(fmi2SetReal(tire, inputs, 2, u))
    CHECK(fmi2ExitInitializationMode(tire))
    CHECK(fmi2GetReal(tire, output, 1, y))
    for (size_t i = 1; i < count; i++) {
        const double *now = u + 3 * i;
        CHECK(fmi2SetReal(tire, inputs, 2, now))
        CHECK(fmi2DoStep(tire, now[-1], now[2] - now[-1], 1))
        CHECK(fmi2GetReal(tire, output, 1, y + i))
        if (i == count / 2) {
            CHECK(fmi2GetFMUstate(tire, &state))
            CHECK(fmi2SerializedFMUstateSize(tire, state, &size))
            char *bytes = malloc(size);
            CHECK(fmi2SerializeFMUstate(tire, state, bytes, size))
            CHECK(fmi2SetReal(tire, inputs, 2, away))
            for (int k = 0; k < 10; k++)
                CHECK(fmi2DoStep(tire, now[2] + 0.01 * k, 0.01, 1))
            CHECK(fmi2DeSerializeFMUstate(tire, bytes, size, &again))
            CHECK(fmi2SetFMUstate(tire, again))
            CHECK(fmi2FreeFMUstate(tire, &again))
            CHECK(fmi2FreeFMUstate(tire, &state))
            free(bytes);
        }
    }
    CHECK(fmi2Terminate(tire))
    fmi2FreeInstance(tire);
    file = fopen(argv[5], "wb");
    fwrite(y, sizeof *y, count, file);
    fclose(file);
    return 0;
}
