// Run an unpacked FMU in CasADi's C++ library, in Model Exchange: with_casadi FOLDER me < pairs of inputs, one a line.
//
// Prints "forces" and a force for each pair, then "slopes" and the force's derivative by the deflection; where CasADi
// refused something, its message, and ends with 3.
#include <casadi/casadi.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

using casadi::DM;

static void add(std::string& line, double value) {
    char text[32];
    std::snprintf(text, sizeof text, " %.17g", value);
    line += text;
}

int main(int count, char** words) try {
    if (count != 3 || std::string(words[2]) != "me") return 2;
    casadi::DaeBuilder tire("tire", words[1], {{"debug", false}});
    tire.set_causality("in_tested_range", "local");  // CasADi reads outputs as Reals
    const casadi::Function law = tire.create("law", {"u", "p"}, {"y"}), slope = law.jacobian();
    const DM parameters(tire.start(tire.p()));
    std::string forces = "forces", slopes = "slopes";
    double deflection, radius;
    while (std::scanf("%lf %lf", &deflection, &radius) == 2) {
        const DM inputs(std::vector<double>{deflection, radius});
        const DM output = law(std::vector<DM>{inputs, parameters}).at(0);
        add(forces, output(0).scalar());
        add(slopes, slope(std::vector<DM>{inputs, parameters, output}).at(0)(0, 0).scalar());
    }
    std::printf("%s\n%s\n", forces.c_str(), slopes.c_str());
    return 0;
} catch (const std::exception& refused) {
    std::printf("%s\n", refused.what());
    return 3;
}
