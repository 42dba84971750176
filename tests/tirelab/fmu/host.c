/*
 * An FMI 2.0 master with no Python in it: opens an FMU's binary, runs it in many ways, and exits 0 when all went well.
 *
 *     host LIBRARY RESOURCES GUID INPUT,INPUT,OUTPUT MODE [ARGUMENT ...]
 *
 * RESOURCES "-" hands over NULL, GUID is handed over as it is, the three value references are of Real variables.
 * Modes: run VALUE...          one full life, twice, closing and opening the library in between; prints the outputs
 *        bad                   a step with NaN, then one with a good value, with logging off
 *        retry                 a step with NaN, again and again as long as it is discarded; prints the last status
 *        first                 seconds of the first instantiation
 *        silent                one step without a logger
 *        threads N             N threads, each with instances of its own, all at once, two generations of threads
 *        relay N               one instance handed through N threads, one after another, which then end
 *        cycles N              N times instantiate and free
 *        reopen N              N times open, instantiate, free and close
 *        steps N               N steps, with get and set of states
 *        bench N LIBRARY       against another FMU, in short turns, as the pace of a machine varies: the least seconds
 *                              for one chain of set (2 values), step and get (1 value) of both, the median ratio
 *        pace N                nanoseconds of a chain of set, step and get, the least of many turns of N
 *        lives N               nanoseconds of an instance made and freed, the least of turns of N, and kB lost over all
 *        crowd N M             M instances in two threads, N steps in all; nanoseconds of a step
 *        two LIBRARY RESOURCES GUID   a second FMU beside the first: made at the same time, stepped in turn, closed
 *                              by threads that end after that; prints the outputs
 *        elsewhere             instantiate in a thread that ends, exit in another one, and free the instance after that
 *        fork                  go on in the child of a fork, and end both
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

typedef struct {
    const char *path, *resources, *guid;
    void *handle;
    void *(*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    void (*free_instance)(void *);
    int (*setup)(void *, int, double, double, int, double), (*enter)(void *), (*leave)(void *), (*terminate)(void *);
    int (*reset)(void *), (*step)(void *, double, double, int);
    int (*set)(void *, const unsigned *, size_t, const double *), (*get)(void *, const unsigned *, size_t, double *);
    int (*get_state)(void *, void **), (*set_state)(void *, void *), (*free_state)(void *, void **);
    int (*state_size)(void *, void *, size_t *), (*serialize)(void *, void *, char *, size_t);
    int (*deserialize)(void *, const char *, size_t, void **);
} Unit;

static unsigned reference[3];
static const double WIDTH = 0.01; /* of a step, s */

static void fail(const char *what)
{
    fprintf(stderr, "host: %s\n", what);
    exit(1);
}

static void check(int status, const char *what)
{
    if (status)
        fail(what);
}

static void print_message(void *unused, const char *name, int status, const char *category, const char *format, ...)
{
    va_list arguments;
    (void)unused;
    printf("[%s, %d, %s] ", name, status, category);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
}

static const Callbacks callbacks = {print_message, calloc, free, NULL, NULL}, silent = {NULL, calloc, free, NULL, NULL};

static void open_unit(Unit *unit)
{
    if (!(unit->handle = dlopen(unit->path, RTLD_NOW | RTLD_LOCAL)))
        fail(dlerror());
#define LOOK_UP(member, name) *(void **)&unit->member = dlsym(unit->handle, "fmi2" name)
    LOOK_UP(instantiate, "Instantiate");
    LOOK_UP(free_instance, "FreeInstance");
    LOOK_UP(setup, "SetupExperiment");
    LOOK_UP(enter, "EnterInitializationMode");
    LOOK_UP(leave, "ExitInitializationMode");
    LOOK_UP(terminate, "Terminate");
    LOOK_UP(reset, "Reset");
    LOOK_UP(step, "DoStep");
    LOOK_UP(set, "SetReal");
    LOOK_UP(get, "GetReal");
    LOOK_UP(get_state, "GetFMUstate");
    LOOK_UP(set_state, "SetFMUstate");
    LOOK_UP(free_state, "FreeFMUstate");
    LOOK_UP(state_size, "SerializedFMUstateSize");
    LOOK_UP(serialize, "SerializeFMUstate");
    LOOK_UP(deserialize, "DeSerializeFMUstate");
    const char *(*version)(void);
    *(void **)&version = dlsym(unit->handle, "fmi2GetVersion");
    if (!version || strcmp(version(), "2.0"))
        fail("no FMI 2.0 in this library");
}

static void *make(const Unit *unit, const Callbacks *functions)
{
    void *instance = unit->instantiate("tire", 1, unit->guid, unit->resources, functions, 0, 0);
    if (!instance)
        fail("fmi2Instantiate returned NULL");
    check(unit->setup(instance, 0, 0, 0, 0, 0), "fmi2SetupExperiment");
    check(unit->enter(instance), "fmi2EnterInitializationMode");
    check(unit->leave(instance), "fmi2ExitInitializationMode");
    return instance;
}

static double step(const Unit *unit, void *instance, long number, double value)
{
    double values[2] = {value, INFINITY}, result = NAN;
    check(unit->set(instance, reference, 2, values), "fmi2SetReal");
    check(unit->step(instance, WIDTH * (double)number, WIDTH, 1), "fmi2DoStep");
    check(unit->get(instance, reference + 2, 1, &result), "fmi2GetReal");
    return result;
}

static void *copy_state(const Unit *unit, void *instance)
{
    void *state = NULL, *copy = NULL;
    size_t size = 0;
    check(unit->get_state(instance, &state), "fmi2GetFMUstate");
    check(unit->state_size(instance, state, &size), "fmi2SerializedFMUstateSize");
    char *bytes = malloc(size);
    check(unit->serialize(instance, state, bytes, size), "fmi2SerializeFMUstate");
    check(unit->free_state(instance, &state), "fmi2FreeFMUstate");
    if (state)
        fail("fmi2FreeFMUstate left its pointer");
    check(unit->deserialize(instance, bytes, size, &copy), "fmi2DeSerializeFMUstate");
    free(bytes);
    return copy;
}

/* One life: the outputs of all values; then back to the state after the first one, and to the start. */
static void live(const Unit *unit, int count, char **values)
{
    void *instance = make(unit, &callbacks), *state = NULL;
    double first = 0, again;
    for (int i = 0; i < count; i++) {
        double force = step(unit, instance, i, atof(values[i]));
        printf("%.17g\n", force);
        if (!i) {
            first = force;
            state = copy_state(unit, instance);
        }
    }
    check(unit->set_state(instance, state), "fmi2SetFMUstate");
    check(unit->get(instance, reference + 2, 1, &again), "fmi2GetReal");
    if (again != first)
        fail("the restored state gives another output");
    check(unit->free_state(instance, &state), "fmi2FreeFMUstate");
    check(unit->terminate(instance), "fmi2Terminate");
    check(unit->reset(instance), "fmi2Reset");
    unit->free_instance(instance);
}

static void *many_lives(void *unit)
{
    for (int life = 0; life < 5; life++) {
        void *one = make(unit, &callbacks), *other = make(unit, &callbacks);
        for (long i = 0; i < 500; i++) {
            double x = 1e-3 + 1e-5 * (double)i;
            if (step(unit, one, i, x) >= step(unit, other, i, 2 * x))
                fail("instances disturb each other");
        }
        ((Unit *)unit)->free_instance(one);
        ((Unit *)unit)->free_instance(other);
    }
    return NULL;
}

static const Unit *relay_unit;
static long relayed;
static void *carry(void *instance)
{
    if (!instance)
        return make(relay_unit, &callbacks);
    if (!(step(relay_unit, instance, relayed++, 0.01) > 0))
        fail("no force after the hand-over");
    return instance;
}

static void *in_thread(void *(*work)(void *), void *argument)
{
    pthread_t thread;
    void *result;
    pthread_create(&thread, NULL, work, argument);
    pthread_join(thread, &result);
    return result;
}

static void *late_instance;
static void free_late(void) { relay_unit->free_instance(late_instance); }

static void *make_first(void *unit) { return make(unit, &callbacks); }

/* Ends after the library is closed that has served it. */
static void *use_and_close(void *argument)
{
    Unit *unit = argument;
    void *instance = make(unit, &callbacks);
    step(unit, instance, 0, 0.01);
    unit->free_instance(instance);
    dlclose(unit->handle);
    return NULL;
}

static void *leave_process(void *unused)
{
    (void)unused;
    exit(0);
}

static long resident(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*d %ld", &pages) != 1)
        fail("/proc/self/statm");
    fclose(file);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Seconds for one chain of set, step and get. */
static double chain(const Unit *unit, void *instance, long first, long count)
{
    double start = now();
    for (long i = first; i < first + count; i++)
        step(unit, instance, i, 1e-3 * (double)(1 + i % 20));
    return (now() - start) / (double)count;
}

static int compare(const void *one, const void *other)
{
    return (*(const double *)one > *(const double *)other) - (*(const double *)one < *(const double *)other);
}

static const Unit *crowd_unit;
static long crowd_size, crowd_steps;

/* Half of the instances and half of the steps, each instance in turn. */
static void *half_a_crowd(void *unused)
{
    const long size = crowd_size / 2, rounds = crowd_steps / crowd_size;
    void **instances = malloc(sizeof(void *) * (size_t)size);
    (void)unused;
    for (long i = 0; i < size; i++)
        instances[i] = make(crowd_unit, &callbacks);
    for (long round = 0; round < rounds; round++)
        for (long i = 0; i < size; i++)
            step(crowd_unit, instances[i], round, 0.012 + 1e-6 * (double)i);
    for (long i = 0; i < size; i++)
        crowd_unit->free_instance(instances[i]);
    free(instances);
    return NULL;
}

int main(int argc, char **argv)
{
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (argc < 6 || sscanf(argv[4], "%u,%u,%u", reference, reference + 1, reference + 2) != 3)
        fail("LIBRARY RESOURCES GUID INPUT,INPUT,OUTPUT MODE [ARGUMENT ...]");
    Unit unit = {.path = argv[1], .resources = strcmp(argv[2], "-") ? argv[2] : NULL, .guid = argv[3]};
    const char *mode = argv[5];
    long count = argc > 6 ? atol(argv[6]) : 0;
    open_unit(&unit);
    if (!strcmp(mode, "run")) {
        live(&unit, argc - 6, argv + 6);
        dlclose(unit.handle);
        open_unit(&unit);
        live(&unit, argc - 6, argv + 6);
    } else if (!strcmp(mode, "bad")) {
        void *instance = make(&unit, &callbacks);
        double values[2] = {NAN, INFINITY};
        check(unit.set(instance, reference, 2, values), "fmi2SetReal");
        printf("%d\n", unit.step(instance, 0, WIDTH, 1));
        printf("%.17g\n", step(&unit, instance, 0, 0.01));
        unit.free_instance(instance);
    } else if (!strcmp(mode, "retry")) {
        void *instance = make(&unit, &callbacks);
        double values[2] = {NAN, INFINITY};
        int status = 2;
        check(unit.set(instance, reference, 2, values), "fmi2SetReal");
        while (status == 2) /* fmi2Discard */
            status = unit.step(instance, 0, WIDTH, 1);
        printf("%d\n", status);
        check(unit.reset(instance), "fmi2Reset");
        unit.free_instance(instance);
    } else if (!strcmp(mode, "first")) {
        double start = now();
        void *instance = unit.instantiate("tire", 1, unit.guid, unit.resources, &callbacks, 0, 0);
        printf("%.4f\n", now() - start);
        if (!instance)
            fail("fmi2Instantiate returned NULL");
        unit.free_instance(instance);
    } else if (!strcmp(mode, "silent")) {
        void *instance = make(&unit, &silent);
        double values[2] = {NAN, INFINITY};
        check(unit.set(instance, reference, 2, values), "fmi2SetReal");
        unit.step(instance, 0, WIDTH, 1);
        unit.free_instance(instance);
    } else if (!strcmp(mode, "threads")) {
        pthread_t threads[64];
        for (int generation = 0; generation < 2; generation++) {
            for (long i = 0; i < count && i < 64; i++)
                pthread_create(threads + i, NULL, many_lives, &unit);
            for (long i = 0; i < count && i < 64; i++)
                pthread_join(threads[i], NULL);
        }
    } else if (!strcmp(mode, "relay")) {
        relay_unit = &unit;
        void *instance = NULL;
        long before = 0;
        for (long i = 0; i < count; i++) {
            instance = in_thread(carry, instance);
            before = i == count / 10 ? resident() : before;
        }
        printf("%ld\n", resident() - before);
        unit.free_instance(instance);
    } else if (!strcmp(mode, "cycles") || !strcmp(mode, "reopen")) {
        long before = 0;
        for (long i = 0; i < count; i++) {
            unit.free_instance(make(&unit, &callbacks));
            if (!strcmp(mode, "reopen")) {
                dlclose(unit.handle);
                open_unit(&unit);
            }
            before = i ? before : resident();
        }
        printf("%ld\n", resident() - before);
    } else if (!strcmp(mode, "steps")) {
        void *instance = make(&unit, &callbacks), *state = NULL;
        long before = 0;
        for (long i = 0; i < count; i++) {
            step(&unit, instance, i, 1e-3 * (double)(i % 20));
            if (i % 10 == 0) {
                check(unit.get_state(instance, &state), "fmi2GetFMUstate");
                check(unit.set_state(instance, state), "fmi2SetFMUstate");
                check(unit.free_state(instance, &state), "fmi2FreeFMUstate");
            }
            before = i == count / 10 ? resident() : before;
        }
        printf("%ld\n", resident() - before);
        unit.free_instance(instance);
    } else if (!strcmp(mode, "bench") && argc == 8) {
        enum { ROUNDS = 101, SHARE = 32 };
        Unit other = {.path = argv[7], .guid = argv[3]};
        open_unit(&other);
        void *one = make(&unit, &callbacks), *two = make(&other, &callbacks);
        double best = INFINITY, best_other = INFINITY, ratios[ROUNDS];
        for (int i = 0; i < ROUNDS; i++) {
            double time = chain(&unit, one, i * (count / SHARE), count / SHARE);
            double other_time = chain(&other, two, i * count, count);
            best = fmin(best, time);
            best_other = fmin(best_other, other_time);
            ratios[i] = time / other_time;
        }
        qsort(ratios, ROUNDS, sizeof *ratios, compare);
        printf("%.3e\n%.3e\n%.1f\n", best, best_other, ratios[ROUNDS / 2]);
        unit.free_instance(one);
        other.free_instance(two);
    } else if (!strcmp(mode, "pace")) {
        void *instance = make(&unit, &callbacks);
        double best = INFINITY;
        long number = 0;
        for (int turn = 0; turn < 1000; turn++) { /* short ones: some fall between two of the system's interruptions */
            double start = now();
            for (long i = 0; i < count; i++, number++)
                step(&unit, instance, number, 0.012 + 0.011 * sin(0.03 * (double)number));
            best = fmin(best, (now() - start) / (double)count);
        }
        printf("%.1f\n", 1e9 * best);
        unit.free_instance(instance);
    } else if (!strcmp(mode, "lives")) {
        double best = INFINITY;
        long before = 0;
        for (int turn = 0; turn < 10; turn++) {
            double start = now();
            for (long i = 0; i < count; i++)
                unit.free_instance(unit.instantiate("tire", 1, unit.guid, unit.resources, &callbacks, 0, 0));
            best = fmin(best, (now() - start) / (double)count);
            before = turn ? before : resident();
        }
        printf("%.0f\n%ld\n", 1e9 * best, resident() - before);
    } else if (!strcmp(mode, "crowd")) {
        pthread_t threads[2];
        crowd_unit = &unit;
        crowd_size = argc > 7 ? atol(argv[7]) : 1000;
        crowd_steps = count;
        double start = now();
        for (int i = 0; i < 2; i++)
            pthread_create(threads + i, NULL, half_a_crowd, NULL);
        for (int i = 0; i < 2; i++)
            pthread_join(threads[i], NULL);
        printf("%.1f\n", 1e9 * (now() - start) / (double)count);
    } else if (!strcmp(mode, "two") && argc == 9) {
        Unit other = {.path = argv[6], .resources = argv[7], .guid = argv[8]};
        pthread_t threads[2];
        void *one, *two;
        open_unit(&other);
        pthread_create(threads, NULL, make_first, &unit);
        pthread_create(threads + 1, NULL, make_first, &other);
        pthread_join(threads[0], &one);
        pthread_join(threads[1], &two);
        for (int i = 0; i < 2; i++) {
            double first = step(&unit, one, i, 0.01), second = step(&other, two, i, 0.01);
            printf("%.17g\n%.17g\n", first, second);
        }
        other.free_instance(two);
        unit.free_instance(one);
        in_thread(use_and_close, &other);
        in_thread(use_and_close, &unit);
        return 0;
    } else if (!strcmp(mode, "fork")) {
        int state = -1;
        void *instance = make(&unit, &callbacks);
        pid_t child = fork();
        step(&unit, instance, 0, 0.01);
        if (!child)
            exit(0);
        if (waitpid(child, &state, 0) != child || state)
            fail("the child of a fork did not end well");
        unit.free_instance(instance);
    } else if (!strcmp(mode, "elsewhere")) {
        relay_unit = &unit;
        atexit(free_late);
        late_instance = in_thread(carry, in_thread(carry, NULL));
        in_thread(leave_process, NULL);
    } else
        fail("no such mode");
    dlclose(unit.handle);
    return 0;
}
