// A quarter of a half ball (radius R) on a quarter of a block, in hexahedra that grow away from the first contact.
//     gmsh -3 -format msh41 -bin sphere.geo -o sphere.msh
R = 10;                 // radius
angle = 20 * Pi / 180;  // the fine part of the ball, seen from its centre
depth = 0.40 * R;       // and its height on the axis
n = 10;                  // elements along each edge of the fine part
grow = 1.26;            // ratio of neighbours
W = 20; H = 20;         // width and height of the block
gap = 0.01;             // between ball and block at the start
m = 6; more = 1.6;      // elements of the block beyond its fine part, ratio of neighbours

// ---- the ball: centre O, poles A (x), B (y), P (down); four hexahedra, one at each of these points
s = Sin(angle); c = Cos(angle);
t = Tan(angle) / Sqrt(1 + 2 * Tan(angle)^2);   // towards the middle of the fine part of the surface
u = 1 / Sqrt(1 + 2 * Tan(angle)^2);
Point(1) = {0, 0, R};
Point(2) = {R, 0, R};
Point(3) = {0, R, R};
Point(4) = {0, 0, 0};
Point(5) = {R * s, 0, R - R * c};              // on the arc A-P
Point(6) = {0, R * s, R - R * c};              // on the arc B-P
Point(7) = {R * Sqrt(0.5), R * Sqrt(0.5), R};  // on the arc A-B
Point(8) = {R * t, R * t, R - R * u};          // on the ball
Point(9) = {0.45 * R, 0, R};                   // on O-A
Point(10) = {0, 0.45 * R, R};                  // on O-B
Point(11) = {0, 0, depth};                     // on O-P
Point(12) = {0.32 * R, 0.32 * R, R};           // inside the plane O-A-B
Point(13) = {0.30 * R, 0, 0.36 * R};           // inside the plane O-A-P
Point(14) = {0, 0.30 * R, 0.36 * R};           // inside the plane O-B-P
Point(15) = {0.24 * R, 0.24 * R, 0.38 * R};    // inside

// the fine part: three families of parallel edges, growing away from P
Circle(1) = {4, 1, 5};  Line(2) = {11, 13};  Circle(3) = {6, 1, 8};  Line(4) = {14, 15};
Circle(5) = {4, 1, 6};  Line(6) = {11, 14};  Circle(7) = {5, 1, 8};  Line(8) = {13, 15};
Line(9) = {4, 11};      Line(10) = {5, 13};  Line(11) = {6, 14};     Line(12) = {8, 15};
Transfinite Curve{1:12} = n + 1 Using Progression grow;
// the rest
Circle(13) = {5, 1, 2}; Circle(14) = {6, 1, 3}; Circle(15) = {2, 1, 7}; Circle(16) = {3, 1, 7}; Circle(17) = {8, 1, 7};
Line(18) = {1, 9};  Line(19) = {9, 2};  Line(20) = {1, 10}; Line(21) = {10, 3}; Line(22) = {11, 1};
Line(23) = {9, 12}; Line(24) = {10, 12}; Line(25) = {12, 7};
Line(26) = {13, 9}; Line(27) = {14, 10}; Line(28) = {15, 12};
// lines opposite to those of the fine part have as many elements
Transfinite Curve{18, 24, 16, 20, 23, 15} = n + 1;
Transfinite Curve{19, 21, 25} = n + 1 Using Progression 1 / grow;
k = 6;                  // elements from the fine part to the middle of the ball
Transfinite Curve{22, 26, 27, 28, 13, 14, 17} = k + 1;

// the surface of the ball
Curve Loop(1) = {1, 7, -3, -5};      Surface(1) = {1} In Sphere{1};
Curve Loop(2) = {13, 15, -17, -7};   Surface(2) = {2} In Sphere{1};
Curve Loop(3) = {14, 16, -17, -3};   Surface(3) = {3} In Sphere{1};
// the plane y = 0 (O-A-P)
Curve Loop(4) = {1, 10, -2, -9};     Plane Surface(4) = {4};
Curve Loop(5) = {13, -19, -26, -10}; Plane Surface(5) = {5};
Curve Loop(6) = {2, 26, -18, -22};   Plane Surface(6) = {6};
// the plane x = 0 (O-B-P)
Curve Loop(7) = {5, 11, -6, -9};     Plane Surface(7) = {7};
Curve Loop(8) = {14, -21, -27, -11}; Plane Surface(8) = {8};
Curve Loop(9) = {6, 27, -20, -22};   Plane Surface(9) = {9};
// the top (O-A-B)
Curve Loop(10) = {18, 23, -24, -20}; Plane Surface(10) = {10};
Curve Loop(11) = {19, 15, -25, -23}; Plane Surface(11) = {11};
Curve Loop(12) = {21, 16, -25, -24}; Plane Surface(12) = {12};
// inside
Curve Loop(13) = {2, 8, -4, -6};     Surface(13) = {13};
Curve Loop(14) = {10, 8, -12, -7};   Surface(14) = {14};
Curve Loop(15) = {11, 4, -12, -3};   Surface(15) = {15};
Curve Loop(16) = {8, 28, -23, -26};  Surface(16) = {16};
Curve Loop(17) = {4, 28, -24, -27};  Surface(17) = {17};
Curve Loop(18) = {12, 28, 25, -17};  Surface(18) = {18};
Surface Loop(1) = {1, 4, 7, 13, 14, 15};    Volume(1) = {1};
Surface Loop(2) = {6, 9, 10, 13, 16, 17};   Volume(2) = {2};
Surface Loop(3) = {2, 5, 11, 14, 16, 18};   Volume(3) = {3};
Surface Loop(4) = {3, 8, 12, 15, 17, 18};   Volume(4) = {4};

// ---- the block: its fine part has nodes nearly below those of the ball, which node-to-segment contact asks for
Point(31) = {0, 0, -gap};
Point(32) = {R * s, 0, -gap};  Point(33) = {R * t, R * t, -gap};  Point(34) = {0, R * s, -gap};
Point(35) = {W, 0, -gap};      Point(36) = {W, W, -gap};          Point(37) = {0, W, -gap};
Line(31) = {31, 32};  Line(32) = {34, 33};  Line(33) = {31, 34};  Line(34) = {32, 33};
Transfinite Curve{31:34} = n + 1 Using Progression grow;
Line(35) = {32, 35};  Line(36) = {33, 36};  Line(37) = {34, 37};
Transfinite Curve{35:37} = m + 1 Using Progression more;
Line(38) = {35, 36};  Line(39) = {37, 36};
Transfinite Curve{38, 39} = n + 1 Using Progression grow;
Curve Loop(31) = {31, 34, -32, -33};  Plane Surface(31) = {31};
Curve Loop(32) = {35, 38, -36, -34};  Plane Surface(32) = {32};
Curve Loop(33) = {37, 39, -36, -32};  Plane Surface(33) = {33};
Transfinite Surface{31:33};
Recombine Surface{31:33};
deep = 13; deeper = 1.33;  // layers of elements downwards, ratio of neighbours
For i In {1:deep}
    one[i - 1] = 1;
    below[i - 1] = (deeper^i - 1) / (deeper^deep - 1);
EndFor
a[] = Extrude {0, 0, -H} { Surface{31}; Layers{one[], below[]}; Recombine; };
b[] = Extrude {0, 0, -H} { Surface{32}; Layers{one[], below[]}; Recombine; };
c[] = Extrude {0, 0, -H} { Surface{33}; Layers{one[], below[]}; Recombine; };

Transfinite Surface{1:18};
Recombine Surface{1:18};
Transfinite Volume{1:4};

Physical Volume("sphere") = {1:4};
Physical Volume("block") = {a[1], b[1], c[1]};
Physical Surface("sphere_surface") = {1};
Physical Surface("sphere_top") = {10:12};
Physical Surface("block_top") = {31:33};
Physical Surface("block_bottom") = {a[0], b[0], c[0]};
Physical Surface("sym_x") = {7:9, a[5], c[2]};
Physical Surface("sym_y") = {4:6, a[2], b[2]};
