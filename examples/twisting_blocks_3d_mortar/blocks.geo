// A cube on a plate; their meshes do not match, and do so less and less while the cube turns about its axis.
//     gmsh -3 -format msh41 blocks.geo -o blocks.msh

// numbers from t on; about the axis z, of half width a, from z0, of height 0.5: n cells along the edges, 2 along z
Macro Brick
  Point(t) = {-a, -a, z0}; Point(t + 1) = {a, -a, z0}; Point(t + 2) = {a, a, z0}; Point(t + 3) = {-a, a, z0};
  Line(t) = {t, t + 1}; Line(t + 1) = {t + 1, t + 2}; Line(t + 2) = {t + 2, t + 3}; Line(t + 3) = {t + 3, t};
  Transfinite Curve{t, t + 1, t + 2, t + 3} = n + 1;
  Curve Loop(t) = {t, t + 1, t + 2, t + 3}; Plane Surface(t) = {t};
  Transfinite Surface{t}; Recombine Surface{t};
  out[] = Extrude {0, 0, 0.5} { Surface{t}; Layers{2}; Recombine; };
Return

t = 100; a = 1.0; z0 = -0.5; n = 7; Call Brick;
Physical Volume("plate") = {out[1]}; Physical Surface("base") = {t}; Physical Surface("top") = {out[0]};
t = 200; a = 0.5; z0 = 0.0; n = 6; Call Brick;
Physical Volume("cube") = {out[1]}; Physical Surface("foot") = {t}; Physical Surface("head") = {out[0]};
