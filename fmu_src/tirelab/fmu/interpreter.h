/* A Python interpreter for any process, and its functions by their own names: python.Py_IsInitialized() and so on. */
#ifndef INTERPRETER_H
#define INTERPRETER_H

#include <stddef.h>
#include <wchar.h>

typedef struct Object Object; /* Python's PyObject, never looked into: any build of Python will do */

#define PYTHON_API(F) \
    F(const char *, Py_GetVersion, (void)) \
    F(int, Py_IsInitialized, (void)) \
    F(void, Py_InitializeEx, (int)) \
    F(int, Py_FinalizeEx, (void)) \
    F(void *, PyEval_SaveThread, (void)) \
    F(void, PyEval_RestoreThread, (void *)) \
    F(int, PyGILState_Ensure, (void)) \
    F(void, PyGILState_Release, (int)) \
    F(void *, PyGILState_GetThisThreadState, (void)) \
    F(void, PyThreadState_Clear, (void *)) \
    F(void, PyThreadState_DeleteCurrent, (void)) \
    F(Object *, PyImport_ImportModule, (const char *)) \
    F(Object *, PyRun_String, (const char *, int, Object *, Object *)) \
    F(Object *, PyObject_CallFunction, (Object *, const char *, ...)) \
    F(Object *, PyObject_CallMethod, (Object *, const char *, const char *, ...)) \
    F(Object *, PyObject_VectorcallMethod, (Object *, Object *const *, size_t, Object *)) \
    F(int, PyObject_IsTrue, (Object *)) \
    F(int, PyArg_ParseTuple, (Object *, const char *, ...)) \
    F(Object *, Py_BuildValue, (const char *, ...)) \
    F(Object *, PyDict_New, (void)) \
    F(Object *, PyDict_GetItemString, (Object *, const char *)) \
    F(ptrdiff_t, PyList_Size, (Object *)) \
    F(Object *, PySequence_GetItem, (Object *, ptrdiff_t)) \
    F(Object *, PyTuple_New, (ptrdiff_t)) \
    F(int, PyTuple_SetItem, (Object *, ptrdiff_t, Object *)) \
    F(Object *, PyFloat_FromDouble, (double)) \
    F(double, PyFloat_AsDouble, (Object *)) \
    F(Object *, PyLong_FromLong, (long)) \
    F(long, PyLong_AsLong, (Object *)) \
    F(Object *, PyBool_FromLong, (long)) \
    F(Object *, PyUnicode_FromString, (const char *)) \
    F(Object *, PyUnicode_InternFromString, (const char *)) \
    F(const char *, PyUnicode_AsUTF8, (Object *)) \
    F(Object *, PyBytes_FromStringAndSize, (const char *, ptrdiff_t)) \
    F(int, PyBytes_AsStringAndSize, (Object *, char **, ptrdiff_t *)) \
    F(Object *, PyErr_Occurred, (void)) \
    F(void, PyErr_Fetch, (Object **, Object **, Object **)) \
    F(void, PyErr_NormalizeException, (Object **, Object **, Object **)) \
    F(void, PyErr_Clear, (void)) \
    F(void, Py_IncRef, (Object *)) \
    F(void, Py_DecRef, (Object *))

#pragma GCC visibility push(hidden)

#define POINTER(result, name, parameters) result (*name) parameters;
extern struct python {
    PYTHON_API(POINTER)
    Object *False;
} python;

/* Uses the interpreter of this process, or finds and starts one; writes a sentence into `trouble` if there is none. */
int start_python(char *trouble, size_t size);

/* Around everything that calls Python: take_python is false once the interpreter has ended, else sets `held`. */
int take_python(int *held);
void leave_python(int held);

#pragma GCC visibility pop
#endif
