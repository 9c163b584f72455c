// Two rings, 0.5 to 1 and 1 to 1.5; they overlap, and the outer one is turned by 0.3 of its cells. Quadratic quadrilaterals.
//     gmsh -2 -order 2 -format msh41 rings.geo -o rings.msh
DefineConstant[overlap = 1e-3, fine = 1];     // fine: by how much cells are smaller
Macro Ring                     // in three parts, since arcs have to be shorter than half a circle
  Point(n) = {0, 0, 0};
  For i In {0 : 2}
    angle = turn + 2 * Pi * i * Floor(around / 3) / around;
    Point(n + 1 + i) = {ri * Cos(angle), ri * Sin(angle), 0};
    Point(n + 4 + i) = {ro * Cos(angle), ro * Sin(angle), 0};
    Line(n + 1 + i) = {n + 1 + i, n + 4 + i};
    Transfinite Curve{n + 1 + i} = 4 * fine + 1;
  EndFor
  For i In {0 : 2}
    next = (i + 1) % 3;
    cells = i < 2 ? Floor(around / 3) : around - 2 * Floor(around / 3);
    Circle(n + 4 + i) = {n + 1 + i, n, n + 1 + next};
    Circle(n + 7 + i) = {n + 4 + i, n, n + 4 + next};
    Transfinite Curve{n + 4 + i, n + 7 + i} = cells + 1;
    Curve Loop(n + i) = {n + 1 + i, n + 7 + i, -(n + 1 + next), -(n + 4 + i)};
    Plane Surface(n + i) = {n + i};
    Transfinite Surface{n + i};
    Recombine Surface{n + i};
  EndFor
Return
n = 10;  ri = 0.5;  ro = 1 + overlap / 2;  around = 37 * fine;  turn = 0;
Call Ring;
n = 30;  ri = 1 - overlap / 2;  ro = 1.5;  around = 48 * fine;  turn = 0.3 * 2 * Pi / around;
Call Ring;
Mesh.SecondOrderIncomplete = 1;
Physical Surface("inner") = {10, 11, 12};
Physical Surface("outer") = {30, 31, 32};
Physical Curve("hub") = {17, 18, 19};      // outside of the inner ring
Physical Curve("bore") = {34, 35, 36};     // inside of the outer ring
Physical Curve("rim") = {37, 38, 39};
