// Half of a half cylinder (radius R) on half of a block, in quadrilaterals of sizes that do not match at the contact.
//     gmsh -2 -format msh41 -bin coarse.geo -o coarse.msh
R = 10;           // radius
W = 40; H = 40;   // width and height of the block
gap = 0.005;      // between cylinder and block at the start
fine = 0.17;      // size of elements of the cylinder at the contact
other = 0.23;     // and of the block
reach = 1.2;      // and how far they go

Point(1) = {0, R, 0};  Point(2) = {R, R, 0};  Point(3) = {0, 0, 0};
Circle(1) = {3, 1, 2};  Line(2) = {2, 1};  Line(3) = {1, 3};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Point(11) = {0, -gap, 0};  Point(12) = {W, -gap, 0};  Point(13) = {W, -H, 0};  Point(14) = {0, -H, 0};
Line(11) = {12, 11};  Line(12) = {11, 14};  Line(13) = {14, 13};  Line(14) = {13, 12};
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};

Field[1] = Distance;
Field[1].PointsList = {3, 11};
Field[2] = MathEval;
Field[2].F = Sprintf("%g + 0.25 * Max(F1 - %g, 0)", fine, reach);
Field[3] = MathEval;
Field[3].F = Sprintf("%g + 0.25 * Max(F1 - %g, 0)", other, reach);
Field[4] = Restrict;
Field[4].InField = 2;
Field[4].SurfacesList = {1};
Field[5] = Restrict;
Field[5].InField = 3;
Field[5].SurfacesList = {11};
Field[6] = Min;
Field[6].FieldsList = {4, 5};
Background Field = 6;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 8;
Mesh.RecombinationAlgorithm = 1;
Recombine Surface{1, 11};

Physical Surface("cylinder") = {1};
Physical Surface("block") = {11};
Physical Curve("cylinder_surface") = {1};
Physical Curve("cylinder_top") = {2};
Physical Curve("block_top") = {11};
Physical Curve("block_bottom") = {13};
Physical Curve("symmetry") = {3, 12};
