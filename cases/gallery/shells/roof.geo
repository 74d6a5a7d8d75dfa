// A quarter of a cylindrical roof, mm; gmsh -2 -order 2 -format msh41 roof.geo
radius = 2540; half_length = 254; half_angle = 0.1; parts = 8;
Point(1) = {0, 0, radius * (1 - Cos(half_angle))};
Point(2) = {radius * Sin(half_angle), 0, 0};
Point(3) = {0, 0, -radius * Cos(half_angle)};
Circle(1) = {1, 3, 2};
Transfinite Curve{1} = parts + 1;
out[] = Extrude {0, half_length, 0} { Curve{1}; Layers{parts}; };
Physical Surface("roof") = {out[1]};
Physical Curve("middle") = {1};      // the plane of symmetry y = 0
Physical Curve("ridge") = {out[3]};  // the plane of symmetry x = 0
Physical Curve("hinge") = {out[2]};
Physical Point("crown") = {1};
