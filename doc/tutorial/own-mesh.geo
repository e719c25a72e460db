// A tube along the x axis: outer radius 10 mm, wall 2 mm, length 30 mm.
// Lengths are in mm. Made into own-mesh.msh by
//   gmsh -3 -format msh22 own-mesh.geo
inner = 8; outer = 10; length = 30;
n_quarter = 8; n_wall = 2; n_long = 18; // cells around a quarter, across, along

// One end as four quarters of a ring, each with four sides.
Point(1) = {-length/2, 0, 0};
For q In {0:3}
  Point(10 + q) = {-length/2, inner*Cos(Pi/2*q), inner*Sin(Pi/2*q)};
  Point(20 + q) = {-length/2, outer*Cos(Pi/2*q), outer*Sin(Pi/2*q)};
EndFor
For q In {0:3}
  next = (q + 1) % 4;
  Circle(30 + q) = {10 + q, 1, 10 + next};
  Circle(40 + q) = {20 + q, 1, 20 + next};
  Line(50 + q) = {10 + q, 20 + q};
EndFor
For q In {0:3}
  next = (q + 1) % 4;
  Curve Loop(60 + q) = {50 + q, 40 + q, -(50 + next), -(30 + q)};
  Plane Surface(70 + q) = {60 + q};
EndFor

// Transfinite and recombined: quadrilaterals, which the extrusion turns into
// hexahedra.
Transfinite Curve{30:33, 40:43} = n_quarter + 1;
Transfinite Curve{50:53} = n_wall + 1;
Transfinite Surface{70:73};
Recombine Surface{70:73};
// Of each quarter: the far end, the volume, four sides.
tube[] = Extrude{length, 0, 0}{ Surface{70:73}; Layers{n_long}; Recombine; };

// The number of a physical surface is the name of the face in the scene; faces
// that are in none are called 0. Only what is in a physical group is written.
Physical Surface(1) = {70:73, tube[0], tube[6], tube[12], tube[18]};
Physical Volume(1) = {tube[1], tube[7], tube[13], tube[19]};
