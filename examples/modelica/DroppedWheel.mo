within ;
model DroppedWheel "A wheel falls onto the ground and bounces on its tire"
  parameter Real mass(final unit="kg", min=0.001) = 3 "Mass on the tire";
  parameter Real height(final unit="m", min=0) = 0.005 "Gap between tire and ground at the start";
  parameter Real surface_radius(final unit="m") = 1e5 "Radius of the ground: convex > 0, concave < 0, flat from 1e5 on";
  BicycleTireOM tire;
  Real deflection(final unit="m", start=-height, fixed=true);
  Real rate(final unit="m/s", start=0, fixed=true);
equation
  der(deflection) = rate;
  mass*der(rate) = mass*9.81 - tire.radial_force;
  tire.deflection = deflection;
  tire.surface_radius = surface_radius;
  annotation (experiment(StopTime=0.5, Tolerance=1e-8));
end DroppedWheel;
