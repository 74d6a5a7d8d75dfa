// A stage in the middle of a clamped film, mm; gmsh -2 -order 2 -format msh41 slider.geo
frame_x = 60; frame_y = 40; stage_x = 10; stage_y = 20;
size = 2.5;
Point(1) = {-frame_x / 2, -frame_y / 2, 0, size}; Point(2) = {frame_x / 2, -frame_y / 2, 0, size};
Point(3) = {frame_x / 2, frame_y / 2, 0, size};   Point(4) = {-frame_x / 2, frame_y / 2, 0, size};
Point(5) = {-stage_x / 2, -stage_y / 2, 0, size}; Point(6) = {stage_x / 2, -stage_y / 2, 0, size};
Point(7) = {stage_x / 2, stage_y / 2, 0, size};   Point(8) = {-stage_x / 2, stage_y / 2, 0, size};
// Where the two electrodes meet, above and below the stage
Point(9) = {0, -frame_y / 2, 0, size};
Point(10) = {0, -stage_y / 2, 0, size};
Point(11) = {0, stage_y / 2, 0, size};
Point(12) = {0, frame_y / 2, 0, size};
Line(1) = {1, 9}; Line(2) = {9, 2}; Line(3) = {2, 3}; Line(4) = {3, 12}; Line(5) = {12, 4}; Line(6) = {4, 1};
Line(7) = {5, 10}; Line(8) = {10, 6}; Line(9) = {6, 7}; Line(10) = {7, 11}; Line(11) = {11, 8}; Line(12) = {8, 5};
Line(13) = {9, 10}; Line(14) = {11, 12};
Curve Loop(1) = {1, 13, -7, -12, -11, 14, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -14, -10, -9, -8, -13}; Plane Surface(2) = {2};
Curve Loop(3) = {7, 8, 9, 10, 11, 12}; Plane Surface(3) = {3};
Physical Surface("left") = {1};
Physical Surface("right") = {2};
Physical Surface("stage") = {3};
Physical Curve("frame") = {1, 2, 3, 4, 5, 6};
Physical Curve("ribs") = {7, 8, 9, 10, 11, 12};
