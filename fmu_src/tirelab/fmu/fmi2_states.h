/*
 * Which function of FMI 2.0 is allowed in which state: the tables of sections 3.2.3 (Model Exchange) and 4.2.4
 * (Co-Simulation) of the standard 2.0.5.
 *
 * Its states stepInProgress, stepFailed and stepCanceled do not occur here: a step is made or refused at once. After an
 * error the standard leaves only a reset or a saved state; a host that sets a good value instead may go on all the same.
 * In Continuous-Time Mode the standard lets a host set inputs alone; CasADi sets parameters there too, and they are taken.
 * There alone it lets a host set continuous states; OpenModelica sets them in Event Mode too, with the values that it has
 * just read, before it goes there for the first time.
 */
#ifndef FMI2_STATES_H
#define FMI2_STATES_H

typedef enum {
    INSTANTIATED = 1,
    INITIALIZATION = 2,
    STEP_COMPLETE = 4,
    EVENT = 8,
    CONTINUOUS = 16,
    TERMINATED = 32
} State;

/* Beside the states: of one kind of simulation only. */
enum { OF_EXCHANGE = 64, OF_STEPS = 128 };

enum {
    ANY = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | EVENT | CONTINUOUS | TERMINATED,
    RUNNING = STEP_COMPLETE | EVENT | CONTINUOUS,
    MAY_SetDebugLogging = ANY,
    MAY_FreeInstance = ANY,
    MAY_Reset = ANY,
    MAY_SetupExperiment = INSTANTIATED,
    MAY_EnterInitializationMode = INSTANTIATED,
    MAY_ExitInitializationMode = INITIALIZATION,
    MAY_Terminate = RUNNING,
    MAY_Get = INITIALIZATION | RUNNING | TERMINATED,
    MAY_SetReal = INSTANTIATED | INITIALIZATION | RUNNING,
    MAY_Set = INSTANTIATED | INITIALIZATION | STEP_COMPLETE | EVENT,
    MAY_FMUstate = ANY,
    MAY_GetDirectionalDerivative = INITIALIZATION | RUNNING | TERMINATED,
    MAY_SetRealInputDerivatives = OF_STEPS | INSTANTIATED | INITIALIZATION | STEP_COMPLETE,
    MAY_GetRealOutputDerivatives = OF_STEPS | STEP_COMPLETE | TERMINATED,
    MAY_DoStep = STEP_COMPLETE,
    MAY_CancelStep = 0,
    MAY_GetStatus = OF_STEPS | STEP_COMPLETE | TERMINATED,
    MAY_EnterEventMode = EVENT | CONTINUOUS,
    MAY_NewDiscreteStates = EVENT,
    MAY_EnterContinuousTimeMode = EVENT,
    MAY_CompletedIntegratorStep = CONTINUOUS,
    MAY_SetTime = EVENT | CONTINUOUS,
    MAY_SetContinuousStates = EVENT | CONTINUOUS,
    MAY_GetContinuous = OF_EXCHANGE | INITIALIZATION | EVENT | CONTINUOUS | TERMINATED,
    MAY_GetNominalsOfContinuousStates = INSTANTIATED | MAY_GetContinuous
};

/* The state in the standard's words. */
static inline const char *state_name(State state)
{
    switch (state) {
    case INSTANTIATED:
        return "instantiated";
    case INITIALIZATION:
        return "Initialization Mode";
    case STEP_COMPLETE:
        return "stepComplete";
    case EVENT:
        return "Event Mode";
    case CONTINUOUS:
        return "Continuous-Time Mode";
    default:
        return "terminated";
    }
}

#endif
