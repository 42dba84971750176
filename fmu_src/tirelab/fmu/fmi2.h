/* The types of FMI 2.0 (its fmi2TypesPlatform.h and fmi2FunctionTypes.h), as far as they are needed here. */
#ifndef FMI2_H
#define FMI2_H

#include <stddef.h>

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL, PENDING } Status;
enum { MODEL_EXCHANGE = 0, CO_SIMULATION = 1, LAST_SUCCESSFUL_TIME = 2, HAS_TERMINATED = 3 };
typedef unsigned Reference;
typedef const char *String;
typedef struct {
    void (*logger)(void *environment, String instance, Status, String category, String message, ...);
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*step_finished)(void *, Status);
    void *environment;
} Callbacks;

#endif
