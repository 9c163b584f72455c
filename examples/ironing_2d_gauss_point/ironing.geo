// A slab, and an indenter with a round foot above its left end, in quadratic quadrilaterals.
//     gmsh -2 -order 2 -format msh41 ironing.geo -o ironing.msh
DefineConstant[along = 24];    // cells along the slab; all others follow
W = 12;  H = 4;                // the slab
w = 1.2;  h = 1.2;  R = 0.75;  // the indenter: width, height, radius of its foot
left = 0.2;  gap = 0.2;

Point(1) = {0, 0, 0};  Point(2) = {W, 0, 0};  Point(3) = {W, H, 0};  Point(4) = {0, H, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = along + 1;
Transfinite Curve{2, -4} = Round(0.25 * along) + 1 Using Progression 1 / 1.08 ^ (60 / along);
Transfinite Surface{1};

x = left + w / 2;  foot = H + gap;
c = Sqrt(R * R - w * w / 4);
Point(11) = {x, foot + R, 0};  Point(12) = {x - w / 2, foot + R - c, 0};  Point(13) = {x + w / 2, foot + R - c, 0};
Point(14) = {x + w / 2, foot + h, 0};  Point(15) = {x - w / 2, foot + h, 0};
Circle(11) = {12, 11, 13};  Line(12) = {13, 14};  Line(13) = {14, 15};  Line(14) = {15, 12};
Curve Loop(11) = {11, 12, 13, 14};
Plane Surface(11) = {11};
Transfinite Curve{11, 13} = Round(along / 6) + 1;
Transfinite Curve{12, 14} = Round(along / 10) + 1;
Transfinite Surface{11};
Recombine Surface{1, 11};
Mesh.SecondOrderIncomplete = 1;

Physical Surface("slab") = {1};
Physical Surface("indenter") = {11};
Physical Curve("slab_top") = {3};
Physical Curve("base") = {1};
Physical Curve("foot") = {11, 12, 14};
Physical Curve("head") = {13};
