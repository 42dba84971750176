/*
 * The FMU's Linux binary: FMI 2.0 for Co-Simulation on one side, a slave class of pythonfmu on the other.
 *
 * It takes the place of pythonfmu's own library, which works only in processes that hold Python already, and reads the
 * same resources: slavemodule.txt names the module that defines a subclass of Fmi2Slave. To build it takes neither
 * Python's headers nor libpython:
 *
 *     cc -std=c11 -O2 -shared -fPIC -pthread -o BicycleTire.so loader.c interpreter.c -ldl
 */
#define _GNU_SOURCE
#include "fmi2.h"
#include "fmi2_states.h"
#include "interpreter.h"
#include "make_slave.h"

#include <dlfcn.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))

/* The value references of the last call of a kind, as hosts mostly repeat them. */
typedef struct {
    Reference *numbers;
    size_t count;
    Object *tuple;
} References;

typedef struct {
    Callbacks host;
    int verbose;      /* the host wants to hear of successes too */
    char *name;
    Object *slave;    /* the instance of the slave class */
    Object *messages; /* its list of messages */
    Object *values;   /* what it returned last: strings handed out live in there */
    References set, got;
    double reached;   /* the end of the last step that was made, the start where there was none */
    State state;
} Instance;

static Object *names; /* what make_slave.h defines */
static Object *part(String name) { return python.PyDict_GetItemString(names, name); }

/* Hands a message to the host: '%' doubled, as the host reads a printf format, and always with a category. */
static void tell(const Instance *self, Status status, String category, String message)
{
    static const String categories[] = {"logAll", "logStatusWarning", "logStatusDiscard",
                                        "logStatusError", "logStatusFatal", "logAll"};
    char *format = malloc(2 * strlen(message) + 1), *end = format;
    if (!format)
        return;
    for (; *message; *end++ = *message++)
        if (*message == '%')
            *end++ = '%';
    *end = 0;
    status = status <= PENDING ? status : ERROR;
    if (self->host.logger && (status != OK || self->verbose))
        self->host.logger(self->host.environment, self->name, status,
                          category && *category ? category : categories[status], format);
    free(format);
}

/* The same while this thread holds Python: the host may wait in its logger for another thread, which may need it. */
static void tell_outside(const Instance *self, Status status, String category, String message)
{
    void *state = python.PyEval_SaveThread();
    tell(self, status, category, message);
    python.PyEval_RestoreThread(state);
}

/* Tells the host of the exception that was raised. */
static Status fail(const Instance *self, String where)
{
    Object *type = NULL, *error = NULL, *trace = NULL, *text = NULL;
    char line[2000], *words = NULL;
    python.PyErr_Fetch(&type, &error, &trace);
    python.PyErr_NormalizeException(&type, &error, &trace);
    if (names && error)
        text = python.PyObject_CallFunction(part("explain"), "(O)", error);
    if (!text || python.PyBytes_AsStringAndSize(text, &words, NULL))
        python.PyErr_Clear();
    snprintf(line, sizeof line, "%s: %s", where, words ? words : "an error that cannot be put in words");
    python.Py_DecRef(text);
    python.Py_DecRef(type);
    python.Py_DecRef(error);
    python.Py_DecRef(trace);
    tell_outside(self, ERROR, NULL, line);
    return ERROR;
}

/*
 * Makes a status of a result and hands on the messages of the slave. An exception is an Error; False is a Discard, or an
 * Error where a message says so.
 */
static Status conclude(const Instance *self, String where, Object *result)
{
    Status status = OK;
    if (!result || python.PyErr_Occurred())
        status = fail(self, where);
    else if (result == python.False)
        status = DISCARD;
    python.Py_DecRef(result);
    for (ptrdiff_t left = python.PyList_Size(self->messages); left > 0; left--) {
        Object *message = python.PyObject_CallFunction(part("take"), "(O)", self->messages);
        int grade;
        String category, text;
        if (message && python.PyArg_ParseTuple(message, "izy", &grade, &category, &text)) {
            status = status == DISCARD && grade == ERROR ? ERROR : status;
            tell_outside(self, (Status)grade, category, text);
        } else
            status = fail(self, "message");
        python.Py_DecRef(message);
    }
    return status;
}

/* Takes a new instance of the slave class, in place of the one before. */
static int adopt(Instance *self, Object *slave)
{
    Object *messages = slave ? python.PyObject_CallMethod(slave, "_get_log_queue", NULL) : NULL;
    if (!messages || python.PyList_Size(messages) < 0) {
        python.Py_DecRef(messages);
        python.Py_DecRef(slave);
        return 0;
    }
    python.Py_DecRef(self->slave);
    python.Py_DecRef(self->messages);
    self->slave = slave;
    self->messages = messages;
    self->reached = 0;
    self->state = INSTANTIATED;
    return 1;
}

/* The value references as a tuple, which is the same one as long as they are the same. */
static Object *tuple_of(References *last, const Reference numbers[], size_t count)
{
    if (!last->tuple || last->count != count || (count && memcmp(last->numbers, numbers, count * sizeof *numbers))) {
        python.Py_DecRef(last->tuple);
        last->tuple = python.PyTuple_New((ptrdiff_t)count);
        last->count = count;
        last->numbers = realloc(last->numbers, (count + 1) * sizeof *numbers);
        for (size_t i = 0; i < count; i++) {
            last->numbers[i] = numbers[i];
            python.PyTuple_SetItem(last->tuple, (ptrdiff_t)i, python.PyLong_FromLong((long)numbers[i]));
        }
    }
    return last->tuple;
}

/* Calls slave.method(first) or slave.method(first, second); `second` is given away. */
static Object *call(const Instance *self, Object **method, String name, Object *first, Object *second)
{
    Object *arguments[] = {self->slave, first, second}, *result = NULL;
    if (!*method)
        *method = python.PyUnicode_InternFromString(name);
    if (!python.PyErr_Occurred())
        result = python.PyObject_VectorcallMethod(*method, arguments, second ? 3 : 2, NULL);
    python.Py_DecRef(second);
    return result;
}

static Object *from_text(String text) { return python.PyUnicode_FromString(text ? text : ""); }

/* Whether the standard allows a function now; told where it does not. */
static int allowed(const Instance *self, int states, String function)
{
    char line[200];
    if (!self || self->state & states)
        return self != NULL;
    snprintf(line, sizeof line, "fmi2%s is not allowed in the state \"%s\"", function, state_name(self->state));
    tell(self, ERROR, NULL, line);
    return 0;
}

/* Whether there is what a pointer should lead to; told where it is NULL. */
static int given(const Instance *self, int there, String function)
{
    char line[200];
    snprintf(line, sizeof line, "fmi2%s: an argument is NULL", function);
    if (!there)
        tell(self, ERROR, NULL, line);
    return there;
}

/* The frame of every function of an instance; there: whether its arguments are not NULL. */
#define ENTER(states, function, there) \
    Instance *self = c; \
    int held; \
    if (!allowed(self, states, function) || !given(self, there, function) || !take_python(&held)) \
        return ERROR;
#define LEAVE(where, result) \
    Status status = conclude(self, where, result); \
    leave_python(held); \
    return status;
#define METHOD(Name, name, next) \
    EXPORT Status fmi2##Name(void *c) \
    { \
        ENTER(MAY_##Name, #Name, 1) \
        Status status = conclude(self, name, python.PyObject_CallMethod(self->slave, name, NULL)); \
        leave_python(held); \
        self->state = status == OK ? next : self->state; \
        return status; \
    }
#define GET_SET(Name, name, type, to_python, from_python, may_set) \
    EXPORT Status fmi2Set##Name(void *c, const Reference v[], size_t n, const type x[]) \
    { \
        static Object *method; \
        ENTER(may_set, "Set" #Name, !n || (v && x)) \
        Object *values = python.PyTuple_New((ptrdiff_t)n); \
        for (size_t i = 0; i < n; i++) \
            python.PyTuple_SetItem(values, (ptrdiff_t)i, to_python(x[i])); \
        LEAVE("set_" name, call(self, &method, "set_" name, tuple_of(&self->set, v, n), values)) \
    } \
    EXPORT Status fmi2Get##Name(void *c, const Reference v[], size_t n, type x[]) \
    { \
        static Object *method; \
        ENTER(MAY_Get, "Get" #Name, !n || (v && x)) \
        Object *values = call(self, &method, "get_" name, tuple_of(&self->got, v, n), NULL), *value; \
        for (size_t i = 0; values && i < n && (value = python.PySequence_GetItem(values, (ptrdiff_t)i)); i++) { \
            x[i] = (type)from_python(value); \
            python.Py_DecRef(value); \
        } \
        python.Py_DecRef(self->values); \
        python.Py_IncRef(self->values = values); \
        LEAVE("get_" name, values) \
    }
#define UNSUPPORTED(Name, states) /* whatever its other arguments */ \
    EXPORT Status fmi2##Name(void *c) \
    { \
        if (allowed(c, states, #Name)) \
            tell(c, ERROR, NULL, "fmi2" #Name " is not supported"); \
        return ERROR; \
    }

EXPORT String fmi2GetTypesPlatform(void) { return "default"; }
EXPORT String fmi2GetVersion(void) { return "2.0"; }
METHOD(EnterInitializationMode, "enter_initialization_mode", INITIALIZATION)
METHOD(ExitInitializationMode, "exit_initialization_mode", STEP_COMPLETE)
METHOD(Terminate, "terminate", TERMINATED)
GET_SET(Real, "real", double, python.PyFloat_FromDouble, python.PyFloat_AsDouble, MAY_SetReal)
GET_SET(Integer, "integer", int, python.PyLong_FromLong, python.PyLong_AsLong, MAY_Set)
GET_SET(Boolean, "boolean", int, python.PyBool_FromLong, python.PyObject_IsTrue, MAY_Set)
GET_SET(String, "string", String, from_text, python.PyUnicode_AsUTF8, MAY_Set)
UNSUPPORTED(GetDirectionalDerivative, MAY_GetDirectionalDerivative)
UNSUPPORTED(SetRealInputDerivatives, MAY_SetRealInputDerivatives)
UNSUPPORTED(GetRealOutputDerivatives, MAY_GetRealOutputDerivatives)
UNSUPPORTED(CancelStep, MAY_CancelStep)

/* Makes the slave. */
static Status instantiate(Instance *self, String guid, String location, int visible)
{
    Dl_info library;
    Object *defined = names ? NULL : python.PyDict_New();
    if (defined && python.PyRun_String(PYTHON_PART, 257 /* Py_file_input */, defined, defined))
        names = defined;
    dladdr(&names, &library);
    Object *slave = names ? python.PyObject_CallFunction(part("make"), "(yyyyi)", self->name, guid,
                                                         location, library.dli_fname, visible) : NULL;
    if (!adopt(self, slave))
        return fail(self, "fmi2Instantiate");
    return conclude(self, "fmi2Instantiate", python.PyBool_FromLong(1));
}

EXPORT void *fmi2Instantiate(String name, int type, String guid, String location, const Callbacks *host, int visible,
                             int logging)
{
    char trouble[4000];
    int held;
    struct sigaction interrupt;
    Instance *self = host ? calloc(1, sizeof *self) : NULL;
    if (!self || !(self->name = strdup(name ? name : ""))) {
        free(self);
        return NULL;
    }
    self->host = *host;
    self->verbose = logging;
    sigaction(SIGINT, NULL, &interrupt);
    if (type != CO_SIMULATION)
        tell(self, ERROR, NULL, "this FMU is for co-simulation only");
    else if (!start_python(trouble, sizeof trouble))
        tell(self, ERROR, NULL, trouble);
    else if (!take_python(&held))
        tell(self, ERROR, NULL, "the Python interpreter of this process has ended");
    else {
        instantiate(self, guid, location, visible);
        leave_python(held);
    }
    sigaction(SIGINT, &interrupt, NULL); /* up to Python 3.10 the module signal takes Ctrl-C when it is imported */
    if (self->slave)
        return self;
    free(self->name);
    free(self);
    return NULL;
}

EXPORT void fmi2FreeInstance(void *c)
{
    Instance *self = c;
    int held;
    if (!self)
        return;
    if (take_python(&held)) {
        Object *owned[] = {self->slave, self->messages, self->values, self->set.tuple, self->got.tuple};
        for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
            python.Py_DecRef(owned[i]);
        leave_python(held);
    }
    free(self->set.numbers);
    free(self->got.numbers);
    free(self->name);
    free(self);
}

EXPORT Status fmi2SetDebugLogging(void *c, int on, size_t n, const String categories[])
{
    (void)n, (void)categories; /* all of them: the messages are few */
    if (c)
        ((Instance *)c)->verbose = on;
    return c ? OK : ERROR;
}

/* The value, or None where there is none. */
static Object *optional(int given, double value)
{
    return given ? python.PyFloat_FromDouble(value) : python.Py_BuildValue("");
}

EXPORT Status fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop, double stop)
{
    ENTER(MAY_SetupExperiment, "SetupExperiment", 1)
    self->reached = start;
    LEAVE("setup_experiment", python.PyObject_CallMethod(self->slave, "setup_experiment", "(dNN)", start,
                                                         optional(has_stop, stop), optional(has_tolerance, tolerance)))
}

EXPORT Status fmi2Reset(void *c)
{
    ENTER(MAY_Reset, "Reset", 1)
    Object *slave = python.PyObject_CallFunction(part("make_again"), "(O)", self->slave);
    LEAVE("fmi2Reset", adopt(self, slave) ? python.PyBool_FromLong(1) : NULL)
}

EXPORT Status fmi2DoStep(void *c, double time, double step, int no_rewind)
{
    static Object *method;
    (void)no_rewind;
    ENTER(MAY_DoStep, "DoStep", 1)
    Object *start = python.PyFloat_FromDouble(time);
    Object *result = call(self, &method, "do_step", start, python.PyFloat_FromDouble(step));
    python.Py_DecRef(start);
    int made = result ? python.PyObject_IsTrue(result) : 0;
    Status status = conclude(self, "do_step", result);
    leave_python(held);
    if (status == OK && made)
        self->reached = time + step;
    return status == OK && !made ? DISCARD : status;
}

#define GET_STATUS(Name, type, known, value) \
    EXPORT Status fmi2Get##Name##Status(void *c, int kind, type *x) \
    { \
        Instance *self = c; \
        if (!allowed(self, MAY_GetStatus, "Get" #Name "Status") || !given(self, x != NULL, "Get" #Name "Status")) \
            return ERROR; \
        if (kind != (known)) \
            return DISCARD; \
        *x = value; \
        return OK; \
    }
GET_STATUS(, Status, -1, OK) /* none of these can be retrieved: fmi2Discard */
GET_STATUS(Integer, int, -1, 0)
GET_STATUS(String, String, -1, "")
GET_STATUS(Real, double, LAST_SUCCESSFUL_TIME, self->reached)
GET_STATUS(Boolean, int, HAS_TERMINATED, 0)

EXPORT Status fmi2GetFMUstate(void *c, void **state)
{
    ENTER(MAY_FMUstate, "GetFMUstate", state != NULL)
    Object *copy = python.PyObject_CallFunction(part("save"), "(Oid)", self->slave, (int)self->state, self->reached);
    if (copy) {
        python.Py_DecRef(*state); /* by the standard NULL or a state handed out before */
        python.Py_IncRef(*state = copy);
    }
    LEAVE("_get_fmu_state", copy)
}

EXPORT Status fmi2SetFMUstate(void *c, void *state)
{
    ENTER(MAY_FMUstate, "SetFMUstate", state != NULL)
    int stage;
    Object *found = python.PyObject_CallFunction(part("restore"), "(OO)", self->slave, state);
    if (found && python.PyArg_ParseTuple(found, "id", &stage, &self->reached))
        self->state = (State)stage;
    LEAVE("_set_fmu_state", found)
}

EXPORT Status fmi2FreeFMUstate(void *c, void **state)
{
    ENTER(MAY_FMUstate, "FreeFMUstate", 1)
    if (state) {
        python.Py_DecRef(*state);
        *state = NULL;
    }
    leave_python(held);
    return OK;
}

/* Writes a state into `bytes`, if any, of `*size`, and its true size into `*size`. */
static Status serialize(Instance *c, void *state, char bytes[], size_t *size)
{
    char *data = NULL;
    ptrdiff_t length = 0;
    ENTER(MAY_FMUstate, "SerializeFMUstate", state && size)
    Object *text = python.PyObject_CallMethod(self->slave, "_fmu_state_to_bytes", "(O)", state);
    if (text && !python.PyBytes_AsStringAndSize(text, &data, &length) && bytes)
        memcpy(bytes, data, (size_t)length < *size ? (size_t)length : *size);
    *size = (size_t)length;
    LEAVE("_fmu_state_to_bytes", text)
}

EXPORT Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size) { return serialize(c, state, NULL, size); }

EXPORT Status fmi2SerializeFMUstate(void *c, void *state, char bytes[], size_t size)
{
    size_t needed = size;
    Status status = serialize(c, bytes ? state : NULL, bytes, &needed);
    return status == OK && needed > size ? ERROR : status;
}

EXPORT Status fmi2DeSerializeFMUstate(void *c, const char bytes[], size_t size, void **state)
{
    ENTER(MAY_FMUstate, "DeSerializeFMUstate", bytes && state)
    Object *copy = python.PyObject_CallMethod(self->slave, "_fmu_state_from_bytes", "(N)",
                                              python.PyBytes_FromStringAndSize(bytes, (ptrdiff_t)size));
    python.Py_IncRef(*state = copy);
    LEAVE("_fmu_state_from_bytes", copy)
}
