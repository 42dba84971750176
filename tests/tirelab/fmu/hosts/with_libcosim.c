/* Run an FMU with libcosim, a C++ importer: with_libcosim LIBCOSIMC FMU cs < pairs of inputs, one a line.

   LIBCOSIMC is the library of libcosimpy. Prints "forces" and a force for each pair, after a step of 0.01 s; where
   libcosim refused a call, its message, and ends with 3. */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    char name[1024];
    uint32_t reference;
    int type, causality, variability;
} Variable;

static void *library;
static const char *(*last_message)(void);

static void fail(const char *call) {
    printf("%s: %s\n", call, last_message ? last_message() : dlerror());
    exit(3);
}

static void *found(const char *name) {
    void *function = dlsym(library, name);
    if (!function) fail(name);
    return function;
}

#define GET(result, name, ...) \
    result (*name)(__VA_ARGS__); \
    *(void **)&name = found("cosim_" #name)
#define MAKE(name, call) \
    void *name = call; \
    if (!name) fail(#call)
#define TRY(call) \
    if (call < 0) fail(#call)

static uint32_t reference(const Variable *variables, int count, const char *name) {
    for (int i = 0; i < count; i++)
        if (strcmp(variables[i].name, name) == 0) return variables[i].reference;
    fail(name);
    return 0;
}

int main(int count, char **words) {
    if (count != 4 || strcmp(words[3], "cs")) return 2;
    if (!(library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL))) fail("dlopen");
    *(void **)&last_message = found("cosim_last_error_message");
    GET(void *, execution_create, int64_t, int64_t);
    GET(void *, local_slave_create, const char *, const char *);
    GET(void *, override_manipulator_create, void);
    GET(void *, last_value_observer_create, void);
    GET(int, execution_add_slave, void *, void *);
    GET(int, execution_add_manipulator, void *, void *);
    GET(int, execution_add_observer, void *, void *);
    GET(int, slave_get_num_variables, void *, int);
    GET(int, slave_get_variables, void *, int, Variable[], size_t);
    GET(int, manipulator_slave_set_real, void *, int, const uint32_t[], size_t, const double[]);
    GET(int, observer_slave_get_real, void *, int, const uint32_t[], size_t, double[]);
    GET(int, execution_step, void *, size_t);
    GET(int, execution_destroy, void *);
    MAKE(execution, execution_create(0, 10000000)); /* ns */
    MAKE(tire, local_slave_create(words[2], "tire"));
    MAKE(manipulator, override_manipulator_create());
    MAKE(observer, last_value_observer_create());
    const int slave = execution_add_slave(execution, tire);
    TRY(slave);
    TRY(execution_add_manipulator(execution, manipulator));
    TRY(execution_add_observer(execution, observer));
    const int size = slave_get_num_variables(execution, slave);
    TRY(size);
    Variable *variables = calloc((size_t)size, sizeof *variables);
    TRY(slave_get_variables(execution, slave, variables, (size_t)size));
    const uint32_t inputs[2] = {reference(variables, size, "deflection"), reference(variables, size, "surface_radius")};
    const uint32_t output[1] = {reference(variables, size, "radial_force")};
    double values[2], force;
    char forces[4096] = "forces";
    while (scanf("%lf %lf", values, values + 1) == 2) {
        const size_t end = strlen(forces);
        TRY(manipulator_slave_set_real(manipulator, slave, inputs, 2, values));
        TRY(execution_step(execution, 1));
        TRY(observer_slave_get_real(observer, slave, output, 1, &force));
        snprintf(forces + end, sizeof forces - end, " %.17g", force);
    }
    TRY(execution_destroy(execution));
    printf("%s\n", forces);
    fflush(stdout);
    _Exit(0); /* the library's threads need no end of their own */
}
