// Angle bracket: the plates of ../bracket.scad with their slot and hole, without its rib and boss. Each of its
// surfaces is one of the bracket too, except where rib and boss stand there. No symmetry.

use <../bracket.scad>
$fn = 64;  // as there

difference() {
  plates();
  openings();
}
