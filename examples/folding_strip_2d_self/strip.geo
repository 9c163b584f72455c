// A strip folded into a hairpin: two legs and a bend, in quadratic quadrilaterals. The legs have different cells.
//     gmsh -2 -order 2 -format msh41 strip.geo -o strip.msh
L = 3;  a = 0.4;  b = 0.6;     // length of the legs, inner and outer radius of the bend
DefineConstant[fine = 1];      // all numbers of cells are multiplied by it

Point(1) = {0, 0, 0};
Point(2) = {L, a, 0};   Point(3) = {L, b, 0};   Point(4) = {0, b, 0};   Point(5) = {0, a, 0};
Point(6) = {-b, 0, 0};  Point(7) = {-a, 0, 0};
Point(8) = {0, -b, 0};  Point(9) = {0, -a, 0};  Point(10) = {L, -b, 0}; Point(11) = {L, -a, 0};
Line(1) = {2, 3};  Line(2) = {3, 4};  Line(3) = {4, 5};  Line(4) = {5, 2};
Circle(5) = {4, 1, 6};  Line(6) = {6, 7};  Circle(7) = {7, 1, 5};
Circle(8) = {6, 1, 8};  Line(9) = {8, 9};  Circle(10) = {9, 1, 7};
Line(11) = {8, 10};  Line(12) = {10, 11};  Line(13) = {11, 9};
Curve Loop(1) = {1, 2, 3, 4};       Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};      Plane Surface(2) = {2};
Curve Loop(3) = {-6, 8, 9, 10};     Plane Surface(3) = {3};
Curve Loop(4) = {-9, 11, 12, 13};   Plane Surface(4) = {4};
Transfinite Curve{1, 3, 6, 9, 12} = 2 * fine + 1;
Transfinite Curve{2, 4} = 15 * fine + 1;
Transfinite Curve{11, 13} = 12 * fine + 1;
Transfinite Curve{5, 7, 8, 10} = 6 * fine + 1;
Transfinite Surface{1, 2, 3, 4};
Recombine Surface{1, 2, 3, 4};
Mesh.SecondOrderIncomplete = 1;

Physical Surface("strip") = {1, 2, 3, 4};
Physical Curve("inside") = {4, 7, 10, 13};
Physical Curve("upper_inside") = {4};
Physical Curve("lower_inside") = {13};
Physical Curve("upper_end") = {1};
