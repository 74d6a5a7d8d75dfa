// A quarter of a hemisphere with a hole at its top, mm; gmsh -2 -order 2 -format msh41 hemisphere.geo
SetFactory("OpenCASCADE");
radius = 10; highest = 72 * Pi / 180; parts = 16;
Point(1) = {radius, 0, 0};
Point(2) = {radius * Cos(highest), 0, radius * Sin(highest)};
Point(3) = {0, 0, 0};
Circle(1) = {1, 3, 2};
Transfinite Curve{1} = parts + 1;
out[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 2} { Curve{1}; Layers{parts}; };
Physical Surface("film") = {out[1]};
Physical Curve("along_x") = {1};      // the plane of symmetry y = 0
Physical Curve("along_y") = {out[0]}; // the plane of symmetry x = 0
Physical Point("pulled") = {1};
Physical Point("pushed") = {4};
