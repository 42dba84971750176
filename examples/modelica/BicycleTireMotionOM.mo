within ;
block BicycleTireMotionOM
  "BicycleTireOM for a tire with damping, mass or a lag of the deflection, which needs rate and acceleration too"
  extends BicycleTireOM(
    radial_force(min=-Modelica.Constants.inf),
    radial_stiffness(min=-Modelica.Constants.inf));
  Modelica.Blocks.Interfaces.RealInput deflection_rate(
    final quantity="Velocity",
    final unit="m/s") "Rate of the deflection: always to be connected, the tire does not estimate it"
    annotation (Placement(transformation(extent={{-140,0},{-100,40}})));
  Modelica.Blocks.Interfaces.RealInput deflection_acceleration(
    final quantity="Acceleration",
    final unit="m/s2") "Acceleration of the deflection: for a mass or a lag, else 0"
    annotation (Placement(transformation(extent={{-140,-40},{-100,0}})));
equation
  connect(deflection_rate, fmu.deflection_rate);
  connect(deflection_acceleration, fmu.deflection_acceleration);
  annotation (Documentation(info="<html>
<p>Only an FMU whose tire has one of these effects has the two inputs: for any other tire take <code>BicycleTireOM</code>.</p>
</html>"));
end BicycleTireMotionOM;
