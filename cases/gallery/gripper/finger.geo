// A finger of two layers, 20 x 1 mm, rising by 0.5 mm to its tip, mm; gmsh -2 -order 2 -format msh41 finger.geo
length = 20; height = 1; rise = 0.5;
Point(1) = {0, 0, 0};      Point(2) = {length, rise, 0};
Point(3) = {0, height / 2, 0}; Point(4) = {length, rise + height / 2, 0};
Point(5) = {0, height, 0}; Point(6) = {length, rise + height, 0};
Line(1) = {1, 2}; Line(2) = {2, 4}; Line(3) = {3, 4}; Line(4) = {1, 3};
Line(5) = {4, 6}; Line(6) = {5, 6}; Line(7) = {3, 5};
Curve Loop(1) = {1, 2, -3, -4}; Plane Surface(1) = {1};
Curve Loop(2) = {3, 5, -6, -7}; Plane Surface(2) = {2};
Transfinite Curve {1, 3, 6} = 41; Transfinite Curve {2, 4, 5, 7} = 3;
Transfinite Surface {1, 2} Alternated;
Physical Surface("passive") = {1};
Physical Surface("active") = {2};
Physical Curve("jaw") = {1};
Physical Curve("root") = {4, 7};
