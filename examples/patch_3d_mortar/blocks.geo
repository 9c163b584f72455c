// Two blocks of one base whose meshes do not match where they meet, in z = 1.
//     gmsh -3 -order 2 -format msh41 blocks.geo -o blocks.msh
Mesh.SecondOrderIncomplete = 1;
Geometry.AutoCoherence = 0;   // the blocks stay two

// numbers from t on; from z0, of height 1: n cells along x, m along y, 2 along z
Macro Brick
  Point(t) = {0, 0, z0}; Point(t + 1) = {2, 0, z0}; Point(t + 2) = {2, 2, z0}; Point(t + 3) = {0, 2, z0};
  Line(t) = {t, t + 1}; Line(t + 1) = {t + 1, t + 2}; Line(t + 2) = {t + 2, t + 3}; Line(t + 3) = {t + 3, t};
  Transfinite Curve{t, t + 2} = n + 1 Using Bump 0.7;
  Transfinite Curve{t + 1, t + 3} = m + 1 Using Bump 1.4;
  Curve Loop(t) = {t, t + 1, t + 2, t + 3}; Plane Surface(t) = {t};
  Transfinite Surface{t}; Recombine Surface{t};
  out[] = Extrude {0, 0, 1} { Surface{t}; Layers{2}; Recombine; };
Return

t = 100; z0 = 0; n = 3; m = 4; Call Brick;
Physical Volume("lower") = {out[1]}; Physical Surface("base") = {t}; Physical Surface("lower_top") = {out[0]};
t = 200; z0 = 1; n = 5; m = 3; Call Brick;
Physical Volume("upper") = {out[1]}; Physical Surface("foot") = {t}; Physical Surface("head") = {out[0]};
