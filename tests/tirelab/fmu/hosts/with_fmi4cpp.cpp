// Run an FMU with FMI4cpp: with_fmi4cpp FMU cs|me < pairs of inputs, one a line. Prints FMI4cpp's status for what was
// refused, and ends with 3; else "forces" and a force for each pair, after a step (cs) or at its moment (me).
#include <fmi4cpp/fmi4cpp.hpp>

#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

constexpr double STEP = 0.01;

struct refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <typename Instance>
void check(Instance& instance, bool done, const char* call) {
    if (!done) throw refused(call + (": " + fmi4cpp::to_string(instance.last_status())));
}

template <typename Instance>
void begin(Instance& tire) {
    check(tire, tire.setup_experiment(), "setup_experiment");
    check(tire, tire.enter_initialization_mode(), "enter_initialization_mode");
    check(tire, tire.exit_initialization_mode(), "exit_initialization_mode");
}

// Discrete states until nothing is new, then continuous time.
void settle(fmi4cpp::fmi2::me_instance& tire) {
    do {
        check(tire, tire.new_discrete_states(), "new_discrete_states");
    } while (tire.eventInfo_.newDiscreteStatesNeeded);
    check(tire, tire.enter_continuous_time_mode(), "enter_continuous_time_mode");
}

void advance(fmi4cpp::fmi2::cs_slave& tire, double) { check(tire, tire.step(STEP), "step"); }

void advance(fmi4cpp::fmi2::me_instance& tire, double time) {
    fmi2Boolean event = fmi2False, end = fmi2False;
    check(tire, tire.set_time(time), "set_time");
    check(tire, tire.completed_integrator_step(fmi2True, event, end), "completed_integrator_step");
    if (event) {
        check(tire, tire.enter_event_mode(), "enter_event_mode");
        settle(tire);
    }
}

void prepare(fmi4cpp::fmi2::cs_slave&) {}

void prepare(fmi4cpp::fmi2::me_instance& tire) { settle(tire); }

template <typename Instance>
int run(const std::shared_ptr<Instance>& tire) {
    const auto model = tire->get_model_description();
    const auto reference = [&](const char* name) { return model->get_variable_by_name(name).value_reference; };
    const std::vector<fmi2ValueReference> inputs{reference("deflection"), reference("surface_radius")};
    begin(*tire);
    prepare(*tire);
    std::string forces;
    double deflection, radius, force, time = 0.0;
    // Not operator>>: it does not read "nan".
    while (std::scanf("%lf %lf", &deflection, &radius) == 2) {
        check(*tire, tire->write_real(inputs, {deflection, radius}), "write_real");
        advance(*tire, time += STEP);
        check(*tire, tire->read_real(reference("radial_force"), force), "read_real");
        char text[32];
        std::snprintf(text, sizeof text, " %.17g", force);
        forces += text;
    }
    check(*tire, tire->terminate(), "terminate");
    std::cout << "forces" << forces << std::endl;
    return 0;
}

int main(int count, char** words) {
    if (count != 3) return 2;
    try {
        fmi4cpp::fmi2::fmu fmu(words[1]);
        if (std::string(words[2]) == "cs") return run(std::shared_ptr(fmu.as_cs_fmu()->new_instance()));
        return run(std::shared_ptr(fmu.as_me_fmu()->new_instance()));
    } catch (const refused& call) {
        std::cout << call.what() << std::endl;
        return 3;
    }
}
