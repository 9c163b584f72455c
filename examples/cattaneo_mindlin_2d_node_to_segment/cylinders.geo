// Two half cylinders of radius R, one on the other, in quadrilaterals that are fine near the contact.
//     gmsh -2 -format msh41 -bin cylinders.geo -o cylinders.msh
R = 8;
DefineConstant[fine = 0.05];   // size of elements at the contact: below; above 5/6 of it
reach = 0.9;                   // and how far they go

Point(1) = {0, R, 0};  Point(2) = {R, R, 0};  Point(3) = {0, 0, 0};  Point(4) = {-R, R, 0};
Circle(1) = {4, 1, 3};  Circle(2) = {3, 1, 2};  Line(3) = {2, 4};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Point(11) = {0, -R, 0};  Point(12) = {R, -R, 0};  Point(13) = {0, 0, 0};  Point(14) = {-R, -R, 0};
Circle(11) = {12, 11, 13};  Circle(12) = {13, 11, 14};  Line(13) = {14, 12};
Curve Loop(11) = {11, 12, 13};
Plane Surface(11) = {11};

Field[1] = Distance;
Field[1].PointsList = {3};
Field[2] = MathEval;
Field[2].F = Sprintf("%g + 0.25 * Max(F1 - %g, 0)", 5 * fine / 6, reach);
Field[3] = Restrict;
Field[3].InField = 2;
Field[3].SurfacesList = {1};
Field[4] = MathEval;
Field[4].F = Sprintf("%g + 0.25 * Max(F1 - %g, 0)", fine, reach);
Field[5] = Restrict;
Field[5].InField = 4;
Field[5].SurfacesList = {11};
Field[6] = Min;
Field[6].FieldsList = {3, 5};
Background Field = 6;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 8;
Mesh.RecombinationAlgorithm = 1;
Recombine Surface{1, 11};

Physical Surface("upper") = {1};
Physical Surface("lower") = {11};
Physical Curve("upper_round") = {1, 2};
Physical Curve("lower_round") = {11, 12};
Physical Curve("head") = {3};
Physical Curve("base") = {13};
