// Cook's membrane in 16 × 16 quadrilaterals of second order.
//     gmsh -2 -order 2 -format msh41 cook.geo -o cook.msh
n = 16;
Mesh.SecondOrderIncomplete = 1;  // quadrilaterals of eight nodes
Point(1) = {0, 0, 0};  Point(2) = {48, 44, 0};  Point(3) = {48, 60, 0};  Point(4) = {0, 44, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1:4} = n + 1;
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("membrane") = {1};
Physical Curve("wall") = {4};
Physical Curve("end") = {2};
Physical Point("corner") = {3};
