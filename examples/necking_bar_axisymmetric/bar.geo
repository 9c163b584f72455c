// A quarter of a section through a round bar, 1.8 % thinner in the middle: x is the radius, y the axis.
//     gmsh -2 -format msh41 bar.geo -o bar.msh
R = 6.413;  half = 26.667;  thin = 0.982 * R;
across = 10;  along = 30;
Point(1) = {0, 0, 0};  Point(2) = {thin, 0, 0};  Point(3) = {R, half, 0};  Point(4) = {0, half, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = across + 1;
Transfinite Curve{2} = along + 1 Using Progression 1.06;
Transfinite Curve{4} = along + 1 Using Progression 1 / 1.06;
Transfinite Surface{1};
Recombine Surface{1};
Physical Surface("bar") = {1};
Physical Curve("middle") = {1};
Physical Curve("end") = {3};
Physical Curve("axis") = {4};
Physical Point("neck") = {2};
