/* Run an FMU with OMSimulator: with_omsimulator FMU cs|me < pairs of inputs, one a line.

   Prints OMSimulator's messages, then "forces" and a force for each pair, after a step of 0.01 s; ends with 3 where
   OMSimulator refused a call. */
#include <OMSimulator/OMSimulator.h>
#include <stdio.h>
#include <string.h>

#define TIRE "model.root.tire"

static const double step = 0.01;

static void tell(oms_message_type_enu_t type, const char *message) {
    (void)type;
    printf("%s\n", message);
}

static int refused(oms_status_enu_t status, const char *call) {
    if (status == oms_status_ok) return 0;
    printf("%s: status %d\n", call, (int)status);
    return 1;
}

#define TRY(call) \
    if (refused(call, #call)) return 3

static int run(const char *fmu, oms_system_enu_t kind) {
    double deflection, radius, force, time = 0.0;
    char forces[4096] = "forces";
    TRY(oms_newModel("model"));
    TRY(oms_addSystem("model.root", kind));
    TRY(oms_addSubModel(TIRE, fmu));
    TRY(oms_setResultFile("model", "", 0));
    TRY(oms_setStopTime("model", 1.0));
    if (kind == oms_system_wc) TRY(oms_setFixedStepSize("model.root", step));
    TRY(oms_instantiate("model"));
    TRY(oms_initialize("model"));
    while (scanf("%lf %lf", &deflection, &radius) == 2) {
        size_t end = strlen(forces);
        TRY(oms_setReal(TIRE ".deflection", deflection));
        TRY(oms_setReal(TIRE ".surface_radius", radius));
        TRY(oms_stepUntil("model", time += step));
        TRY(oms_getReal(TIRE ".radial_force", &force));
        snprintf(forces + end, sizeof forces - end, " %.17g", force);
    }
    TRY(oms_terminate("model"));
    TRY(oms_delete("model"));
    printf("%s\n", forces);
    return 0;
}

int main(int count, char **words) {
    if (count != 3) return 2;
    oms_setLoggingCallback(tell);
    return run(words[1], strcmp(words[2], "cs") == 0 ? oms_system_wc : oms_system_sc);
}
