/*
 * Finds a Python, starts it once per process and ends it with the process.
 *
 * A process that holds Python already (fmpy, another FMU) is used as it is: never started, never ended. Otherwise
 * libpython is looked for and opened for the whole process, as Python's own extension modules expect it.
 */
#define _GNU_SOURCE
#include "interpreter.h"

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <link.h>
#include <locale.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define OLDEST 10 /* Python 3.10: the first that the tire runs on; said in words in open_python, too */
#define NEWEST 15

struct python python;

/*
 * One lock for all copies of this library in a process (two FMUs bring two), so that only one of them starts Python:
 * the dynamic linker merges a "unique" symbol over all libraries, also over those opened RTLD_LOCAL.
 */
extern pthread_mutex_t tirelab_python_start; /* zeros, as PTHREAD_MUTEX_INITIALIZER */
__asm__(".pushsection .bss\n.balign 16\n.type tirelab_python_start, @gnu_unique_object\n"
        ".size tirelab_python_start, 64\ntirelab_python_start: .zero 64\n.popsection");

/* The Python thread state of a host thread; those of ended threads wait in a list for the next new thread. */
typedef struct Thread {
    void *state;
    struct Thread *next;
} Thread;
static pthread_key_t this_thread;
static pthread_mutex_t ended_lock = PTHREAD_MUTEX_INITIALIZER;
static Thread *ended;

static int ready;
static pthread_t life; /* the thread of the interpreter that was started here */
static pid_t starter;  /* and the process */
static sem_t begun, ending;

static char tried[3000]; /* the search for Python, in words; guarded by tirelab_python_start */

__attribute__((format(printf, 1, 2))) static void note(const char *format, ...)
{
    size_t used = strlen(tried);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(tried + used, sizeof tried - used, format, arguments);
    va_end(arguments);
}

/* Looks up a function; the detour over void ** is POSIX's way round C's ban on casting to a function pointer. */
static int look_up(void *library, const char *name, void *function)
{
    *(void **)function = dlsym(library, name);
    return *(void **)function != NULL;
}

/* The x of Python 3.x in a library or in the process (RTLD_DEFAULT); 0 when it is none or too old. */
static int version(void *library)
{
    const char *(*text)(void);
    int minor = 0;
    if (look_up(library, "Py_GetVersion", &text))
        sscanf(text(), "3.%d", &minor);
    return minor >= OLDEST ? minor : 0;
}

/* Opens a libpython for the whole process, or notes why not. */
static int open_python(const char *path)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    int fit = library && version(library);
    if (fit && dlopen(path, RTLD_NOW | RTLD_GLOBAL))
        return 1;
    note(" (%s)", library && !fit ? "not Python 3.10 or newer" : dlerror());
    if (library)
        dlclose(library);
    return 0;
}

/* Opens the shared library of a Python program by its place, PREFIX/lib beside PREFIX/bin/python3.x, if it is there. */
static int open_beside(const char *program)
{
    char real[PATH_MAX], path[PATH_MAX + 300], name[256];
    char *slash;
    if (access(program, X_OK) || !realpath(program, real) || !(slash = strrchr(real, '/')))
        return 0;
    snprintf(name, sizeof name, "lib%s.so.1.0", slash + 1);
    *slash = 0;
    if (strncmp(name, "libpython3.", 11) || !(slash = strrchr(real, '/')) || strcmp(slash, "/bin"))
        return 0;
    *slash = 0;
    snprintf(path, sizeof path, "%s/lib/%s", real, name);
    if (!access(path, R_OK))
        return open_python(path);
    /* Debian keeps it in a folder of the architecture, which the linker knows. */
    return !strcmp(real, "/usr") && open_python(name);
}

/* The same for every python3 on PATH, in turn: a second interpreter that could be asked takes a while to start. */
static int open_on_path(char program[PATH_MAX])
{
    const char *folders = getenv("PATH");
    for (size_t length; folders && *folders; folders += length + (folders[length] == ':')) {
        length = strcspn(folders, ":");
        if (length && snprintf(program, PATH_MAX, "%.*s/python3", (int)length, folders) < PATH_MAX
            && open_beside(program))
            return 1;
    }
    *program = 0;
    return 0;
}

/* Asks a Python where its shared library and itself are, and opens the library. */
static int ask_python(const char *command, char program[PATH_MAX])
{
    static const char question[] =
        "-I -S -c 'import os, sys, sysconfig\n"
        "name = \"libpython%d.%d%s.so.1.0\" % (sys.version_info[:2] + (sys.abiflags,))\n"
        "folders = [sysconfig.get_config_var(\"LIBDIR\") or \"\", os.path.join(sys.base_prefix, \"lib\")]\n"
        "paths = [path for path in [os.path.join(folder, name) for folder in folders] if os.path.exists(path)]\n"
        "os.write(1, os.fsencode(\"\\n\".join((paths + [\"\"])[:1] + [sys.executable, \"\"])))'";
    char line[sizeof question + 80], path[PATH_MAX] = "";
    note(", %s", command);
    snprintf(line, sizeof line, "exec 2>/dev/null </dev/null; %s %s", command, question);
    FILE *answer = popen(line, "r");
    int answered = answer && fgets(path, sizeof path, answer) && fgets(program, PATH_MAX, answer);
    if (answer)
        pclose(answer);
    path[strcspn(path, "\n")] = 0;
    program[strcspn(program, "\n")] = 0;
    if (!answered || !*path)
        note(answered ? " (without shared library: %s)" : " (none, or too old)", program);
    if (answered && *path && open_python(path))
        return 1;
    *program = 0;
    return 0;
}

/* Finds a libpython that something in this process has opened for itself alone. */
static int is_python(struct dl_phdr_info *library, size_t size, void *found)
{
    (void)size;
    const char *name = strstr(library->dlpi_name, "/libpython3.");
    if (name && strspn(name + 12, "0123456789"))
        *(const char **)found = library->dlpi_name;
    return *(const char **)found != NULL;
}

/* Makes Python's functions visible in the process; `program` becomes the interpreter that was asked, if one was. */
static int find_python(char program[PATH_MAX])
{
    const char *chosen = getenv("TIRELAB_LIBPYTHON"), *loaded = NULL;
    char name[32];
    dl_iterate_phdr(is_python, &loaded);
    if (loaded) { /* a second one beside it would tear both apart */
        note("%s of this process", loaded);
        return open_python(loaded);
    }
    note("TIRELAB_LIBPYTHON%s%s", chosen && *chosen ? "=" : " (not set)", chosen ? chosen : "");
    if (chosen && *chosen)
        return open_python(chosen);
    const char *environment = getenv("VIRTUAL_ENV");
    if (environment && snprintf(program, PATH_MAX, "%s/bin/python", environment) < PATH_MAX && open_beside(program))
        return 1;
    *program = 0;
    if (environment && ask_python("\"$VIRTUAL_ENV/bin/python\"", program))
        return 1;
    if (open_on_path(program) || ask_python("python3", program) || ask_python("python", program))
        return 1;
    note(", the system's libpython3.%d to 3.%d", OLDEST, NEWEST);
    for (int minor = NEWEST; minor >= OLDEST; minor--) {
        snprintf(name, sizeof name, "libpython3.%d.so.1.0", minor);
        if (dlopen(name, RTLD_LAZY | RTLD_LOCAL) && open_python(name))
            return 1;
    }
    return 0;
}

/* Tells Python its program, asked or guessed from the library's place: from there it finds its standard library. */
static void name_program(char program[PATH_MAX])
{
    Dl_info library;
    char guess[PATH_MAX + 32];
    const char *slash;
    wchar_t *(*decode)(const char *, size_t *), *wide;
    void (*set_program)(const wchar_t *);
    if (!*program && dladdr(*(void **)&python.Py_InitializeEx, &library) && (slash = strrchr(library.dli_fname, '/'))) {
        snprintf(guess, sizeof guess, "%.*s/../bin/python3.%d", (int)(slash - library.dli_fname), library.dli_fname,
                 version(RTLD_DEFAULT));
        if (!realpath(guess, program))
            *program = 0;
    }
    if (*program && look_up(RTLD_DEFAULT, "Py_DecodeLocale", &decode)
        && look_up(RTLD_DEFAULT, "Py_SetProgramName", &set_program) && (wide = decode(program, NULL)))
        set_program(wide);
}

/* The life of an interpreter, in a thread of its own, as it must end in the thread in which it began. */
static void *live(void *program)
{
    /* File names in UTF-8; no PYTHONHOME or PYTHONPATH, which may be meant for another Python and end the process. */
    int *utf8 = dlsym(RTLD_DEFAULT, "Py_UTF8Mode"), *alone = dlsym(RTLD_DEFAULT, "Py_IgnoreEnvironmentFlag");
    char *locale = setlocale(LC_CTYPE, NULL);
    locale = locale ? strdup(locale) : NULL;
    if (utf8)
        *utf8 = 1;
    if (alone)
        *alone = 1;
    name_program(program);
    python.Py_InitializeEx(0); /* 0: Ctrl-C stays the host's */
    if (locale)
        setlocale(LC_CTYPE, locale);
    free(locale);
    python.PyImport_ImportModule("threading"); /* takes the thread that imports it first for the main one */
    void *state = python.PyEval_SaveThread();
    sem_post(&begun);
    while (sem_wait(&ending) && errno == EINTR)
        ;
    python.PyEval_RestoreThread(state);
    python.Py_FinalizeEx();
    return NULL;
}

/* At the end of the process, before the static destructors of what Python has loaded. */
static void end_python(void)
{
    if (starter == getpid() && python.Py_IsInitialized()) { /* not in the child of a fork */
        sem_post(&ending);
        pthread_join(life, NULL);
    }
}

/* Starts the interpreter, and keeps this library for its sake; signals keep going to the host's threads. */
static int begin_python(char program[PATH_MAX])
{
    Dl_info self;
    sigset_t all, before;
    sigfillset(&all);
    if (!dladdr(&ready, &self) || !dlopen(self.dli_fname, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE)
        || sem_init(&begun, 0, 0) || sem_init(&ending, 0, 0) || atexit(end_python))
        return 0;
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int failed = pthread_create(&life, NULL, live, program);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    while (!failed && sem_wait(&begun) && errno == EINTR)
        ;
    starter = failed ? 0 : getpid();
    return !failed;
}

/* At the end of a host thread; to wait for the interpreter here could be for ever, if the joining thread holds it. */
static void end_thread(void *thread)
{
    pthread_mutex_lock(&ended_lock);
    ((Thread *)thread)->next = ended;
    ended = thread;
    pthread_mutex_unlock(&ended_lock);
}

/* Gives a host thread a Python thread state for good, so that no call makes and destroys one (ten times slower). */
static void begin_thread(void)
{
    pthread_mutex_lock(&ended_lock);
    Thread *thread = ended, *next;
    ended = NULL;
    pthread_mutex_unlock(&ended_lock);
    for (; thread; thread = next) {
        next = thread->next;
        python.PyEval_RestoreThread(thread->state);
        python.PyThreadState_Clear(thread->state);
        python.PyThreadState_DeleteCurrent();
        free(thread);
    }
    if ((thread = malloc(sizeof *thread))) {
        python.PyGILState_Ensure();
        thread->state = python.PyEval_SaveThread();
        pthread_setspecific(this_thread, thread);
    }
}

/* When the host closes the library: the threads that have used it end without it, and keep their thread states. */
__attribute__((destructor)) static void forget_threads(void)
{
    if (ready)
        pthread_key_delete(this_thread);
}

int take_python(int *held)
{
    if (!python.Py_IsInitialized || !python.Py_IsInitialized())
        return 0;
    if (!python.PyGILState_GetThisThreadState())
        begin_thread();
    *held = python.PyGILState_Ensure();
    return 1;
}

void leave_python(int held) { python.PyGILState_Release(held); }

int start_python(char *trouble, size_t size)
{
    char program[PATH_MAX] = "";
    const char *missing = NULL;
    pthread_mutex_lock(&tirelab_python_start);
    *tried = 0;
    if (ready)
        ;
    else if (!dlsym(RTLD_DEFAULT, "Py_IsInitialized") && !find_python(program))
        snprintf(trouble, size, "no usable Python library among %s; install Python 3.%d or newer with its "
                 "shared library (the package libpython3.x of Debian and Ubuntu, or a Python configured with "
                 "--enable-shared), or set TIRELAB_LIBPYTHON to the path of a libpython3.x.so.1.0", tried, OLDEST);
    else if (!version(RTLD_DEFAULT))
        snprintf(trouble, size, "the Python in this process is older than 3.%d, which is the least", OLDEST);
    else {
#define LOOK_UP(result, name, parameters) missing = look_up(RTLD_DEFAULT, #name, &python.name) ? missing : #name;
        PYTHON_API(LOOK_UP)
        python.False = dlsym(RTLD_DEFAULT, "_Py_FalseStruct");
        if (missing)
            snprintf(trouble, size, "the Python in this process has no %s", missing);
        else if ((!python.Py_IsInitialized() && !begin_python(program)) || pthread_key_create(&this_thread, end_thread))
            snprintf(trouble, size, "the system refuses a thread for Python");
        else
            ready = 1;
    }
    pthread_mutex_unlock(&tirelab_python_start);
    return ready;
}
