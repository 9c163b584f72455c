// A quarter of two tubes, 0.5 to 1 and 1 to 1.5; the inner one is too large by the overlap. Quadratic quadrilaterals.
//     gmsh -2 -order 2 -format msh41 tubes.geo -o tubes.msh
overlap = 0.001;
DefineConstant[around = 9];    // cells around the outer tube; the inner one has 4/3 of them
Macro Tube
  Point(n) = {0, 0, 0};
  Point(n + 1) = {ri, 0, 0};  Point(n + 2) = {ro, 0, 0};  Point(n + 3) = {0, ro, 0};  Point(n + 4) = {0, ri, 0};
  Line(n + 1) = {n + 1, n + 2};  Circle(n + 2) = {n + 2, n, n + 3};  Line(n + 3) = {n + 3, n + 4};  Circle(n + 4) = {n + 4, n, n + 1};
  Curve Loop(n) = {n + 1, n + 2, n + 3, n + 4};
  Plane Surface(n) = {n};
  Transfinite Curve{n + 2, n + 4} = cells + 1;
  Transfinite Curve{n + 1, n + 3} = through + 1;
  Transfinite Surface{n};
  Recombine Surface{n};
Return
n = 10;  ri = 0.5;  ro = 1 + overlap;  cells = Round(4 * around / 3);  through = Round(around / 2);
Call Tube;
n = 20;  ri = 1;  ro = 1.5;  cells = around;  through = Round(around / 3);
Call Tube;
Mesh.SecondOrderIncomplete = 1;
Physical Surface("inner") = {10};
Physical Surface("outer") = {20};
Physical Curve("pin") = {12};
Physical Curve("hole") = {24};
Physical Curve("bore") = {14};
Physical Curve("rim") = {22};
Physical Curve("on_x") = {11, 21};
Physical Curve("on_y") = {13, 23};
