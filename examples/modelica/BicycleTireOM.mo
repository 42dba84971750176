within ;
block BicycleTireOM "Radial force of an off-road bicycle tire on curved ground: BicycleTire.fmu as OpenModelica imports it"
  parameter Real flat_coefficient(min=0.001, max=1e+06) = 550.9
    "C0, C1: A on flat ground [N/cm^B]"
    annotation (Dialog(group="Law"));
  parameter Real convex_coefficient_drop(min=0, max=1e+06) = 337.8
    "D0: loss of A on a sharp edge [N/cm^B]"
    annotation (Dialog(group="Law"));
  parameter Real convex_coefficient_decay(final unit="1/cm", min=0, max=100) = 0.2519
    "E0: rate at which A recovers with the bump's radius; printed as -2519, 0.02519 is the second reading"
    annotation (Dialog(group="Law"));
  parameter Real concave_coefficient_rise(min=0, max=1e+09) = 7822.0
    "D1: gain of A extrapolated to Rb = 0 [N/cm^B]"
    annotation (Dialog(group="Law"));
  parameter Real concave_coefficient_decay(final unit="1/cm", min=0, max=100) = 0.1398
    "E1: rate at which the gain of A fades with the dip's radius"
    annotation (Dialog(group="Law"));
  parameter Real flat_exponent(final unit="1", min=0.1, max=10) = 1.422
    "C2, C3: B on flat ground"
    annotation (Dialog(group="Law"));
  parameter Real convex_exponent_drop(final unit="1", min=0, max=10) = 0.2469
    "D2: loss of B on a sharp edge"
    annotation (Dialog(group="Law"));
  parameter Real convex_exponent_decay(final unit="1/cm", min=0, max=100) = 0.1651
    "E2: rate at which B recovers with the bump's radius"
    annotation (Dialog(group="Law"));
  parameter Real concave_exponent_rise(final unit="1", min=0, max=10) = 0.2128
    "D3: gain of B extrapolated to Rb = 0"
    annotation (Dialog(group="Law"));
  parameter Real concave_exponent_decay(final unit="1/cm", min=0, max=100) = 0.0289
    "E3: rate at which the gain of B fades with the dip's radius"
    annotation (Dialog(group="Law"));
  Modelica.Blocks.Interfaces.RealInput deflection(
    final quantity="Length",
    final unit="m",
    displayUnit="mm",
    min=-1000,
    max=0.33) "Radial compression of the tire; 0 or less in the air"
    annotation (Placement(transformation(extent={{-140,40},{-100,80}})));
  Modelica.Blocks.Interfaces.RealInput surface_radius(
    final quantity="Length",
    final unit="m",
    displayUnit="cm",
    start=1e5) "Radius of curvature of the ground: convex > 0, concave < 0, flat from 1e5 on; not 0"
    annotation (Placement(transformation(extent={{-140,-80},{-100,-40}})));
  Modelica.Blocks.Interfaces.RealOutput radial_force(
    final quantity="Force",
    final unit="N",
    min=0) "Compressive force between tire and ground, along the line from the ground to the hub"
    annotation (Placement(transformation(extent={{100,50},{120,70}})));
  Modelica.Blocks.Interfaces.RealOutput radial_stiffness(
    final quantity="TranslationalSpringConstant",
    final unit="N/m",
    displayUnit="N/mm",
    min=0) "Slope of the force over the deflection"
    annotation (Placement(transformation(extent={{100,-10},{120,10}})));
  Modelica.Blocks.Interfaces.BooleanOutput in_tested_range
    "Whether curvature, deflection and force are within those that were measured"
    annotation (Placement(transformation(extent={{100,-70},{120,-50}})));
protected
  BicycleTire_me_FMU fmu(
    law_flat_coefficient(fixed=true)=flat_coefficient,
    law_convex_coefficient_drop(fixed=true)=convex_coefficient_drop,
    law_convex_coefficient_decay(fixed=true)=convex_coefficient_decay,
    law_concave_coefficient_rise(fixed=true)=concave_coefficient_rise,
    law_concave_coefficient_decay(fixed=true)=concave_coefficient_decay,
    law_flat_exponent(fixed=true)=flat_exponent,
    law_convex_exponent_drop(fixed=true)=convex_exponent_drop,
    law_convex_exponent_decay(fixed=true)=convex_exponent_decay,
    law_concave_exponent_rise(fixed=true)=concave_exponent_rise,
    law_concave_exponent_decay(fixed=true)=concave_exponent_decay)
    "The class that importFMU made of BicycleTire.fmu"
    annotation (Placement(transformation(extent={{-30,-30},{30,30}})));
equation
  connect(deflection, fmu.deflection);
  connect(surface_radius, fmu.surface_radius);
  connect(fmu.radial_force, radial_force);
  connect(fmu.radial_stiffness, radial_stiffness);
  connect(fmu.in_tested_range, in_tested_range);
  annotation (
    Icon(coordinateSystem(extent={{-100,-100},{100,100}}), graphics={
      Ellipse(extent={{-70,-70},{70,70}}, lineThickness=1),
      Line(points={{-100,-70},{100,-70}}),
      Text(extent={{-100,100},{100,70}}, textString="%name")}),
    Documentation(info="<html>
<p>The tire of M. L. Hull, E. L. Wang and D. F. Moore, <em>An empirical model for determining the radial
force-deflection behavior of off-road bicycle tires</em>, Cycling Science, Spring 1996:
<code>F = A x^B</code>, A and B functions of the ground's radius of curvature.</p>
<h4>Import</h4>
<ol>
<li>Build the native FMU: <code>python build_fmu.py --native</code> writes <code>dist/BicycleTire.fmu</code> (FMI 2.0, Model
Exchange beside Co-Simulation; OpenModelica's compiler imports the first).</li>
<li>In <code>omc</code> or in a script for it, <code>importFMU(\"dist/BicycleTire.fmu\")</code> writes the class
<code>BicycleTire_me_FMU</code>; then <code>loadFile(\"BicycleTire_me_FMU.mo\")</code> and
<code>loadFile(\"BicycleTireOM.mo\")</code>. In OMEdit: File, FMU, Import FMU. This block declares <code>fmu</code> with the
names that this import gives: those of the FMU with <code>_</code> for each dot. <code>openmodelica.mos</code> beside this
block does all that.</li>
</ol>
<h4>Connect</h4>
<p><code>deflection</code> is the wheel's unloaded radius (0.33 m for the tire measured) less the distance from the hub to
the ground; <code>surface_radius</code> is the inverse of the ground's mean curvature over the contact, with 1e5 m for
flat ground. Apply <code>radial_force</code> to the hub along the line from the ground, and its opposite to the ground.
A tire that is not pressed gives no force.</p>
<h4>Limits</h4>
<p>This block is for the article's tire. One with effects (damping, mass, an offset of the load cell) has parameters
<code>EFFECT.*</code> too, here <code>EFFECT_*</code>, and its force can be negative. A block that extends this one sets both:
<code>extends BicycleTireOM(radial_force(min=-Modelica.Constants.inf), fmu(force_offset_offset(fixed=true)=5))</code>. With
damping, mass or a lag of the deflection the FMU needs two more inputs: extend <code>BicycleTireMotionOM</code>. A tire that
relaxes or has a force lag has continuous states, and what <code>importFMU</code> writes for them needs
<code>setCommandLineOptions(\"--allowNonStandardModelica=reinitInAlgorithms\")</code> first.</p>
<p>Sharp edges, ground whose radius jumps or changes quickly within the contact, concave ground near the wheel's own
radius, and several contacts at once are outside of what was measured; <code>in_tested_range</code> tells of curvature,
deflection and force. The ten constants of the law are the FMU's parameters <code>law.*</code>.</p>
</html>"));
end BicycleTireOM;
