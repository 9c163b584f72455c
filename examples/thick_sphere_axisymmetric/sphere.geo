// A quarter of a section through a thick-walled sphere: x is the radius, y the axis of revolution.
//     gmsh -2 -order 2 -format msh41 sphere.geo -o sphere.msh
a = 100;  b = 200;   // inner and outer radius
across = 12;  along = 16;
Mesh.SecondOrderIncomplete = 1;  // quadrilaterals of eight nodes
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};  Point(3) = {b, 0, 0};  Point(4) = {0, b, 0};  Point(5) = {0, a, 0};
Line(1) = {2, 3};  Circle(2) = {3, 1, 4};  Line(3) = {4, 5};  Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = across + 1;
Transfinite Curve{2, 4} = along + 1;
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("wall") = {1};
Physical Curve("inside") = {4};
Physical Curve("outside") = {2};
Physical Curve("equator") = {1};
Physical Curve("axis") = {3};
Physical Point("outer_pole") = {4};
Physical Point("outer_equator") = {3};
