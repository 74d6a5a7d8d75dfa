// An eighth of a ball, 6 mm across, about the origin, mm; gmsh -3 -order 2 -format msh41 ball_eighth.geo
SetFactory("OpenCASCADE");
radius = 3;
Sphere(1) = {0, 0, 0, radius, 0, Pi / 2, Pi / 2};
MeshSize {PointsOf {Volume {1};}} = radius / 3;
e = 1e-3;
MeshSize {Point In BoundingBox {-e, radius - e, -e, e, radius + e, e}} = radius / 14;
Physical Volume("ball") = {1};
x0() = Surface In BoundingBox {-e, -e, -e, e, radius + e, radius + e};
y0() = Surface In BoundingBox {-e, -e, -e, radius + e, e, radius + e};
z0() = Surface In BoundingBox {-e, -e, -e, radius + e, radius + e, e};
all() = Boundary {Volume {1};};
skin() = {};
skin() += all();
skin() -= {x0(), y0(), z0()};
Physical Surface("skin") = {skin()};
Physical Surface("side_x") = {x0()};
Physical Surface("middle") = {y0()};
Physical Surface("side_z") = {z0()};
