// Upper half of a round object, 6 mm across, about the origin, mm; gmsh -2 -order 2 -format msh41 ball.geo
radius = 3;
Point(1) = {0, 0, 0, radius / 4};
Point(2) = {radius, 0, 0, radius / 12};
Point(3) = {0, radius, 0, radius / 40};
Point(4) = {-radius, 0, 0, radius / 12};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4};
Line(3) = {4, 1}; Line(4) = {1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Surface("ball") = {1};
Physical Curve("skin") = {1, 2};
Physical Curve("middle") = {3, 4};
Physical Point("centre") = {1};
