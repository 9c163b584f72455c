// A rigid flat punch of radius 1 on a large block: x is the radius, y the axis of revolution.
//     gmsh -2 -format msh41 punch.geo -o punch.msh
W = 400;  fine = 0.01;  gap = 0.001;
Point(1) = {0, -gap, 0};  Point(2) = {1, -gap, 0};  Point(3) = {W, -gap, 0};  Point(4) = {W, -W, 0};  Point(5) = {0, -W, 0};
Line(1) = {3, 2};  Line(2) = {2, 1};  Line(3) = {1, 5};  Line(4) = {5, 4};  Line(5) = {4, 3};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Point(11) = {0, 0, 0};  Point(12) = {1, 0, 0};  Point(13) = {1, 0.5, 0};  Point(14) = {0, 0.5, 0};
Line(11) = {11, 12};  Line(12) = {12, 13};  Line(13) = {13, 14};  Line(14) = {14, 11};
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};
Transfinite Curve{11, 13} = 41;
Transfinite Curve{12, 14} = 2;
Transfinite Surface{11};
Field[1] = Distance;
Field[1].PointsList = {2};
Field[2] = MathEval;
Field[2].F = Sprintf("%g + 0.12 * F1", fine);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 8;
Recombine Surface{1, 11};
Physical Surface("block") = {1};
Physical Surface("punch") = {11};
Physical Curve("block_top") = {1, 2};
Physical Curve("punch_face") = {11};
Physical Curve("block_bottom") = {4};
Physical Curve("axis") = {3};
