// A punch stands on a block: two volumes that touch, and meshes that do not match.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2, 2, 1};
Box(2) = {0.5, 0.5, 1, 1, 1, 1};
Physical Volume("Block") = {1};
Physical Volume("Punch") = {2};
Physical Surface("Floor") = {5};
Physical Surface("Table") = {6};
Physical Surface("Foot") = {11};
Physical Surface("Head") = {12};
MeshSize{ PointsOf{ Volume{1}; } } = 1;
MeshSize{ PointsOf{ Volume{2}; } } = 0.7;
Mesh.MeshSizeExtendFromBoundary = 1;
Mesh.ElementOrder = 2;
Mesh.SaveGroupsOfNodes = 1;
